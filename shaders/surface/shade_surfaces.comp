#version 460
#extension GL_GOOGLE_include_directive : require
// Light of sun and moon for the pixels that show a surface, by tiles: to radiance, or in a frame without later passes to the picture.
// docs/conventions.md.
#define SKERRY_STORED
#include "include/frame/common.glsl"
#include "shared/sky.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
#include "include/frame/islands.glsl"
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(scalar, binding = kPixelStatsBinding) buffer Stats { PixelStats stats; };
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kBlockTexturesBinding) uniform sampler2DArray block_textures;
layout(binding = kSkyTableBinding) uniform sampler2D sky_lut;
layout(binding = kShadowMapsBinding) uniform sampler2DArray shadow_maps;
layout(binding = kMediaLightBinding) uniform usampler2D media_light;
layout(binding = kLayerDepthsBinding) uniform sampler2D layer_depths;  // of the first layer

layout(constant_id = kTextureTapsConstant) const uint kTextureTaps = 2u;

#include "include/scene/tiles.glsl"
#include "include/post/output.glsl"
#include "include/surface/surface.glsl"
#include "include/sky/sky.glsl"
#include "include/surface/lighting.glsl"
#include "include/surface/depth_of_pixel.glsl"
#include "include/surface/haze.glsl"
#include "include/light/corners.glsl"
#include "include/light/indirect.glsl"

void main() {
  uvec2 pixel;
  bool here = tile_pixel(pixel);
  float stored_depth = texelFetch(depths, ivec2(pixel), 0).r;
  uint word = covered_word(imageLoad(surfaces, ivec2(pixel)).r, stored_depth);
  float depth = surface_depth(stored_depth);
  // Pixels of sky go along as some surface near the eye; they are not stored.
  Surface surface = resolve_surface(word, ivec2(pixel), word != 0u ? depth : 1.0, pixel_ray(pixel), kTextureTaps);
  surface.ao = surface_ao(surface, word);
  Depth depth_in_water = depth_of_pixel(pixel, word, surface.position);
  SkyLight sky = light_of_sky(surface, word, sky_share(depth_in_water) * lit_again(depth_in_water));
  vec3 lit = shade_surface(surface, depth_in_water);
  if (kIndirect != kIndirectOff) lit += sky.irradiance * brdf_around(surface_brdf(surface, -normalize(surface.position)));
  vec3 colour = seen_through_air(lit, surface.position, sky.seen);
  put_pixel(pixel, colour, here && word != 0u);
}
