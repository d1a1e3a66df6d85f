// The layer's light image: columns that run along the light, by where they meet the plane in the layer's middle, closer together near the camera.
#ifndef SKERRY_CLOUD_COLUMNS_GLSL
#define SKERRY_CLOUD_COLUMNS_GLSL
#include "shared/clouds.h"

const float kColumnEdge = kLayerLightReach / (kLayerLightReach + kLayerLightNear);

// Horizontal distance that a column covers for each block it rises.
vec2 column_slope(vec3 to_light) { return to_light.xz / max(to_light.y, kLeastLightSine); }

vec2 column_through(vec3 p, vec3 to_light, CloudLayer layer) {
  return p.xz - column_slope(to_light) * (p.y + layer.place.y - 0.5 * layer.thickness);
}
// 0..1 over the image, and back. @param column relative to the camera [blocks].
vec2 column_texel(vec2 column) { return 0.5 + (0.5 / kColumnEdge) * (column / (abs(column) + kLayerLightNear)); }
vec2 column_of_texel(vec2 texel) {
  vec2 u = (texel * 2.0 - 1.0) * kColumnEdge;
  return kLayerLightNear * u / (1.0 - abs(u));
}
#endif
