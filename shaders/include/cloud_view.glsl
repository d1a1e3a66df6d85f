// What march_clouds*.comp and blend_clouds*.comp share: what a pixel's ray has before it.
#include "include/common.glsl"
#include "shared/sky.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
#ifdef SKERRY_LIGHTS
// No uniform buffer: lavapipe crashes on a fourth one in a program that marches (Mesa 22.3).
layout(scalar, binding = 1) readonly buffer Islands { IslandTransform islands[]; };
#endif
layout(scalar, binding = 4) buffer Stats { PixelStats stats; };
#ifndef SKERRY_SKY_ONLY
layout(binding = 5, r32ui) readonly uniform uimage2D surfaces;
layout(binding = 6) uniform sampler2D depths;
layout(binding = 15) uniform sampler2D layer_depths;  // of the nearest water or glass
#endif
layout(binding = 8) uniform sampler2D sky_lut;
layout(binding = 10) uniform sampler2D cloud_weather;
layout(binding = 11) uniform sampler3D cloud_cells;
#ifdef SKERRY_SHADOWS
layout(binding = 12) uniform sampler2DArray shadow_maps;
#endif
layout(binding = 13) uniform sampler3D cloud_bricks;
layout(binding = 16) uniform sampler2DArray cloud_shapes;
layout(binding = 17) uniform sampler2DArray cloud_billows;

layout(constant_id = 6) const bool kDepth16 = false;
layout(constant_id = 22) const bool kTranslucent = false;  // there is water or glass
layout(constant_id = 23) const bool kBehind = false;       // march behind the nearest water or glass, not before it

#include "include/sky.glsl"
#include "include/cloud_light.glsl"
#include "include/cloud_layer.glsl"
#include "include/cloud_volumes.glsl"
#ifdef SKERRY_SHADOWS
#include "include/shadow.glsl"
#endif
#include "include/lighting.glsl"
#ifdef SKERRY_LIGHTS
#include "include/clustered.glsl"
#include "include/traced.glsl"
#endif
#include "include/cloud_march.glsl"

const float kSkyDistance = 1e6;  // blocks

// Distances along the view axis between which a pixel's ray is marched.
vec2 open_way(uvec2 pixel) {
#ifdef SKERRY_SKY_ONLY
  return vec2(0.0, kSkyDistance);
#else
  float depth = texelFetch(depths, ivec2(pixel), 0).r;
  // With 16 bits what lies farthest has depth 0, and only its word tells it from the sky.
  if (kDepth16 && imageLoad(surfaces, ivec2(pixel)).r != 0u) depth = max(depth, 0.5 / 65535.0);
  float surface = depth > 0.0 ? view_distance(depth, frame.near_plane) : kSkyDistance;
  if (!kTranslucent) return vec2(0.0, surface);
  float layer = texelFetch(layer_depths, ivec2(pixel), 0).r;
  float layer_distance = layer > 0.0 ? view_distance(layer, frame.near_plane) : surface;
  return kBehind ? vec2(layer_distance, surface) : vec2(0.0, min(layer_distance, surface));
#endif
}

Clouded clouds_seen(uvec2 pixel, vec2 way, float jitter) {
  vec3 ray = pixel_ray(pixel);
  float stretch = length(ray);
  return march_clouds(pixel, vec3(0.0), ray / stretch, way.x * stretch, way.y * stretch, jitter);
}
