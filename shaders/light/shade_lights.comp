#version 460
#extension GL_GOOGLE_include_directive : require
// Adds the light of the clusters' lights to the surfaces of the tiles that have any, in place on the radiance image.
// The air only takes from it: haze glows of sun and moon alone. docs/conventions.md.
#define SKERRY_STORED
#include "include/frame/common.glsl"
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
layout(binding = kRadianceBinding, rgba16f) uniform image2D radiance;

layout(constant_id = kTextureTapsConstant) const uint kTextureTaps = 2u;

#include "include/scene/tiles.glsl"
#include "include/surface/surface.glsl"
#include "include/light/reflection.glsl"
#include "include/light/clustered.glsl"
#include "include/light/corners.glsl"
#include "include/light/traced.glsl"
#define SKERRY_SHAFTS
#include "include/light/shafts.glsl"
#include "include/light/light_panes.glsl"
#include "include/light/blocked_lights.glsl"

void main() {
  uvec2 pixel;
  bool here = tile_pixel(pixel);
  float stored_depth = texelFetch(depths, ivec2(pixel), 0).r;
  uint word = covered_word(imageLoad(surfaces, ivec2(pixel)).r, stored_depth);
  here = here && word != 0u;
  float depth = here ? surface_depth(stored_depth) : 1.0;
  float z = view_distance(depth, frame.near_plane);
  Cluster list = lights_at(pixel, z);
  if (!here) list.count = 0u;
  Surface s = resolve_surface(word, ivec2(pixel), depth, pixel_ray(pixel), kTextureTaps);
  vec3 to_eye = -normalize(s.position);
  Brdf b = surface_brdf(s, to_eye);
  s.ao = surface_ao(s, word);
  vec3 light = lights_reflected(list, shafts_at(pixel, z), b, way_start(s, word), to_eye) * s.ao;
  vec3 colour = imageLoad(radiance, ivec2(pixel)).rgb + light * clear_air(s.position);
  if (here && !finite3(colour)) atomicAdd(stats.non_finite, 1u);
  if (here) imageStore(radiance, ivec2(pixel), vec4(as_halves(sanitised(colour)), 1.0));
}
