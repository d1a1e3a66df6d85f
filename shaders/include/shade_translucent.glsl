// Body of shade_translucent*.comp: looks through the peeled layers of water and glass from front to back: absorption along each stretch
// inside a medium, light scattered towards the eye, and at each surface Fresnel reflection. In place on the radiance image.
#include "include/common.glsl"
#include "shared/sky.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 1) uniform Islands { IslandTransform islands[kMaxIslands]; };
layout(scalar, binding = 2) uniform Materials { Material materials[kMaxMaterials]; };
layout(scalar, binding = 4) buffer Stats { PixelStats stats; };
layout(binding = 7) uniform sampler2D depths;
layout(binding = 8) uniform sampler2D sky_lut;
layout(binding = 9, rgba16f) uniform image2D radiance;
#ifdef SKERRY_SHADOWS
layout(binding = 10) uniform sampler2DArray shadow_maps;
#include "include/shadow.glsl"
#endif
layout(binding = 11) uniform sampler2DArray block_textures;
layout(binding = 12, r32ui) readonly uniform uimage2D layer_surfaces_0;
layout(binding = 13, r32ui) readonly uniform uimage2D layer_surfaces_1;
layout(binding = 14, r32ui) readonly uniform uimage2D layer_surfaces_2;
layout(binding = 15, r32ui) readonly uniform uimage2D layer_surfaces_3;
layout(binding = 16) uniform sampler2D layer_depths_0;
layout(binding = 17) uniform sampler2D layer_depths_1;
layout(binding = 18) uniform sampler2D layer_depths_2;
layout(binding = 19) uniform sampler2D layer_depths_3;

uint layer_surface(uint k, ivec2 pixel) {
  return k == 0u ? imageLoad(layer_surfaces_0, pixel).r
                 : k == 1u ? imageLoad(layer_surfaces_1, pixel).r
                           : k == 2u ? imageLoad(layer_surfaces_2, pixel).r : imageLoad(layer_surfaces_3, pixel).r;
}
float layer_depth(uint k, ivec2 pixel) {
  return k == 0u ? texelFetch(layer_depths_0, pixel, 0).r
                 : k == 1u ? texelFetch(layer_depths_1, pixel, 0).r
                           : k == 2u ? texelFetch(layer_depths_2, pixel, 0).r : texelFetch(layer_depths_3, pixel, 0).r;
}

#ifdef SKERRY_CLOUDS
layout(binding = 5) uniform sampler2D mirrored_clouds;
layout(constant_id = 25) const bool kMirroredClouds = false;  // whether they are known
#endif

layout(constant_id = 0) const uint kLayers = 3u;

#include "include/tiles.glsl"
#include "include/surface.glsl"
#include "include/sky.glsl"
#ifdef SKERRY_CLOUDS
#include "include/cloud_light.glsl"
#endif
#include "include/lighting.glsl"
#ifdef SKERRY_LIGHTS
#include "include/clustered.glsl"
#include "include/traced.glsl"
#endif
#include "include/ripples.glsl"
#ifdef SKERRY_CLOUDS
#include "include/mirrored_clouds.glsl"
#endif
#include "include/water.glsl"

void main() {
  uvec2 pixel;
  bool here = tile_pixel(pixel);
  // A mixed tile is in both lists: each list does its own pixels.
  here = here && (layer_surface(0u, ivec2(pixel)) != 0u) == (push.kind == 0u);
  vec3 behind = imageLoad(radiance, ivec2(pixel)).rgb;
  vec3 colour = look_through(pixel, pixel_ray(pixel), behind);
  if (here && !finite3(colour)) atomicAdd(stats.non_finite, 1u);
  if (here) imageStore(radiance, ivec2(pixel), vec4(sanitised(colour), 1.0));
}
