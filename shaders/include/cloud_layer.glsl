// Density of the layer: noise that repeats, shaped by a profile of height. Twin, written on its own: tools/reference/clouds.cpp.
// Needs before the include: `cloud_noise` (sampler3D that repeats; bake_cloud_noise.comp).
#ifndef SKERRY_CLOUD_LAYER_GLSL
#define SKERRY_CLOUD_LAYER_GLSL
#include "shared/clouds.h"

float rising(float low, float high, float x) { return clamp((x - low) / (high - low), 0.0, 1.0); }

// Extinction at a place [1/block]. @param p world.
float layer_extinction(vec3 p, CloudLayer layer) {
  float height = (p.y + layer.place.y) / layer.thickness;
  vec3 at = vec3(layer.place.x + p.x, height * layer.thickness, layer.place.z + p.z);
  float weather = textureLod(cloud_noise, vec3(at.x, 0.0, at.z) / kCloudWeatherPeriod, 0.0).a;
  float cover = clamp(layer.coverage * (0.4 + 1.2 * weather), 0.0, 1.0);
  vec2 shape = textureLod(cloud_noise, at / kCloudShapePeriod, 0.0).rg;
  // Flat bases, round tops that reach the higher the more of the sky is covered.
  float profile = rising(0.0, 0.12, height) * (1.0 - rising(0.25 + 0.35 * cover, 0.55 + 0.45 * cover, height));
  float body = rising(1.0 - cover, 1.0, shape.r) * profile;
  if (body <= 0.0) return 0.0;
  float detail = textureLod(cloud_noise, at / kCloudDetailPeriod, 0.0).b;
  float density = rising(0.35 * mix(detail, 1.0 - detail, rising(0.0, 0.2, height)) * (1.0 - body), 1.0, body);
  float fading = 1.0 - rising(kLayerFadeBegin, kLayerFadeEnd, length(p.xz));
  return layer.extinction * density * fading;
}
#endif
