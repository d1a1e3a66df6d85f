// What blend_clouds.comp marches: what a pixel's ray has before it.
#define SKERRY_LIGHTS
#include "shared/constants.h"
#include "include/sky/cloud_ray.glsl"
#include "include/scene/coverage.glsl"
#include "include/scene/layers.glsl"

layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kLayerDepthsBinding) uniform sampler2D layer_depths;  // of the nearest water or glass

// There is no geometry; then something is bound in place of what shows it.
layout(constant_id = kSkyAloneConstant) const bool kSkyAlone = false;
layout(constant_id = kTranslucentConstant) const bool kTranslucent = false;  // there is water or glass
layout(constant_id = kBehindConstant) const bool kBehind = false;       // march behind the nearest water or glass, not before it

// Distances along the view axis between which a pixel's ray is marched.
vec2 open_way(uvec2 pixel) {
  if (kSkyAlone) return vec2(0.0, kSkyDistance);
  float depth = texelFetch(depths, ivec2(pixel), 0).r;
  // With 16 bits what lies farthest has depth 0, and only its word distinguishes it from the sky.
  if (kDepth16 && imageLoad(surfaces, ivec2(pixel)).r != 0u) depth = max(depth, 0.5 / 65535.0);
  float surface = depth > 0.0 ? view_distance(depth, frame.near_plane) : kSkyDistance;
  if (!kTranslucent) return vec2(0.0, surface);
  float layer = layer_depth_at(layer_depths, ivec2(pixel), frame.layers_area);
  float layer_distance = layer > 0.0 ? view_distance(layer, frame.near_plane) : surface;
  return kBehind ? vec2(layer_distance, surface) : vec2(0.0, min(layer_distance, surface));
}

Clouded clouds_seen(uvec2 pixel, vec2 way, float jitter) {
  vec3 ray = pixel_ray(pixel);
  float stretch = length(ray);
  return march_clouds(pixel, vec3(0.0), ray / stretch, way.x * stretch, way.y * stretch, jitter);
}
