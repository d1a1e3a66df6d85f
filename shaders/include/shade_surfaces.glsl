// Body of shade_surfaces*.comp: light for the pixels that show a surface, by tiles. One include, several programs: a frame without shadow
// maps has no image to bind for them, and a frame without later passes writes its picture at once.
#include "include/common.glsl"
#include "shared/sky.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 1) uniform Islands { IslandTransform islands[kMaxIslands]; };
layout(scalar, binding = 2) uniform Materials { Material materials[kMaxMaterials]; };
layout(scalar, binding = 4) buffer Stats { PixelStats stats; };
layout(binding = 5, r32ui) readonly uniform uimage2D surfaces;
layout(binding = 6) uniform sampler2D depths;
layout(binding = 7) uniform sampler2DArray block_textures;
layout(binding = 8) uniform sampler2D sky_lut;
#ifdef SKERRY_SHADOWS
layout(binding = 12) uniform sampler2DArray shadow_maps;
#include "include/shadow.glsl"
#endif

layout(constant_id = 0) const uint kTextureTaps = 2u;

#include "include/tiles.glsl"
#include "include/output.glsl"
#include "include/surface.glsl"
#include "include/sky.glsl"
#ifdef SKERRY_CLOUDS
#include "include/cloud_light.glsl"
#endif
#include "include/lighting.glsl"
#include "include/corners.glsl"

void main() {
  uvec2 pixel;
  bool here = tile_pixel(pixel);
  uint word = imageLoad(surfaces, ivec2(pixel)).r;
  float depth = surface_depth(texelFetch(depths, ivec2(pixel), 0).r);
  // Pixels of sky go along as some surface near the eye; they are not stored.
  Surface surface = resolve_surface(word, ivec2(pixel), word != 0u ? depth : 1.0, pixel_ray(pixel), kTextureTaps);
  surface.openness = surface_openness(surface, word);
  vec3 colour = seen_through_air(shade_surface(surface), surface.position);
  put_pixel(pixel, colour, here && word != 0u);
}
