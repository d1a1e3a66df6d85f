// Light for the pixels that show a surface, by tiles: of sun, moon and sky, and of lamps in those that they reach; to radiance, or in a frame
// without later passes to the picture. Haze glows of sun and moon alone: of lamps' light the air only takes. docs/conventions.md.
#ifndef SKERRY_SHADE_SURFACES_GLSL
#define SKERRY_SHADE_SURFACES_GLSL
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
layout(constant_id = kLitConstant) const bool kLit = false;  // tiles that lamps reach; in others buffers are bound that are never read

#include "include/scene/tiles.glsl"
#include "include/post/output.glsl"
#include "include/surface/surface.glsl"
#include "include/sky/sky.glsl"
#include "include/surface/lighting.glsl"
#include "include/surface/depth_of_pixel.glsl"
#include "include/surface/haze.glsl"
#include "include/light/corners.glsl"
#include "include/light/indirect.glsl"
#include "include/light/clustered.glsl"
#include "include/light/traced.glsl"
#include "include/light/shafts.glsl"
#include "include/light/light_panes.glsl"
#include "include/light/blocked_lights.glsl"

void main() {
  uvec2 pixel;
  bool here = tile_pixel(pixel);
  float stored_depth = texelFetch(depths, ivec2(pixel), 0).r;
  uint word = covered_word(imageLoad(surfaces, ivec2(pixel)).r, stored_depth);
  here = here && word != 0u;
  // Pixels of sky go along as some surface near the eye; they are not stored.
  float depth = word != 0u ? surface_depth(stored_depth) : 1.0;
  Surface surface = resolve_surface(word, ivec2(pixel), depth, pixel_ray(pixel), kTextureTaps);
  surface.ao = surface_ao(surface, word);
  Depth depth_in_water = depth_of_pixel(pixel, word, surface.position);
  SkyLight sky = light_of_sky(surface, word, sky_share(depth_in_water) * lit_again(depth_in_water));
  vec3 lit = shade_surface(surface, depth_in_water), to_eye = -normalize(surface.position);
  Brdf b = surface_brdf(surface, to_eye);
  if (kIndirect != kIndirectOff) lit += sky.irradiance * brdf_around(b);
  vec3 colour = seen_through_air(lit, surface.position, sky.seen);
  if (kLit) {
    float z = view_distance(depth, frame.near_plane);
    Cluster list = lights_at(pixel, z);
    if (!here) list.count = 0u;
    vec3 light = lights_reflected(list, shafts_at(pixel, z), b, way_start(surface, word), to_eye) * surface.ao;
    colour += light * clear_air(surface.position);
  }
  put_pixel(pixel, colour, here);
}
#endif
