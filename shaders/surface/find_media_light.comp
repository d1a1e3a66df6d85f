#version 460
#extension GL_GOOGLE_include_directive : require
// What water and glass do to the light that comes to what pixels show, for depth_of_pixel.glsl: with glass, in tiles with surfaces that light of a
// body may reach; else in those with layers. docs/decisions/0066, 0069.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
#include "include/frame/islands.glsl"
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kLayerSurfacesBinding) uniform usampler2DArray layer_surfaces;
layout(binding = kLayerDepthsBinding) uniform sampler2D layer_depths;  // of the first layer
layout(binding = kGlassMapsBinding) uniform sampler2DArray glass_maps;
layout(binding = kShadowMapsBinding) uniform sampler2DArray shadow_maps;
// x: of the first layer, the block in bits 0-9; in bits 16-31, as a half, how deep below its surface lies what is opaque [blocks], if the layer is
// the surface of level water seen from above, else 0. y: packed_share() of frame.glass_body.
layout(binding = kMediaLightBinding, rg32ui) writeonly uniform uimage2D media_light;

layout(constant_id = kUnderWaterConstant) const bool kUnderWater = false;  // there are layers
layout(constant_id = kGlassConstant) const bool kGlass = false;            // there are maps of glass

#include "include/scene/tiles.glsl"
#include "include/scene/layers.glsl"
#include "include/surface/ripples.glsl"
#include "include/surface/packed_share.glsl"
#include "include/light/glass_sums.glsl"

// @param opaque depth.
uint water_above(uvec2 pixel, float opaque) {
  float z = layer_depth_at(layer_depths, ivec2(pixel), frame.layers_area);
  if (z <= 0.0) return 0u;
  uint word = texelFetch(layer_surfaces, ivec3(pixel, 0), 0).r;
  bool level = frame.camera_medium == 0u && opaque > 0.0 && surface_face(word) == 2u && has_ripples(word);
  vec3 up = world_from_lattice_vector(island_at(surface_island(word)), vec3(0.0, 1.0, 0.0));
  float behind = view_distance(max(opaque, 1e-12), frame.near_plane) - view_distance(z, frame.near_plane);
  float above = level ? max(behind, 0.0) * -dot(up, pixel_ray(pixel)) : 0.0;
  return surface_block(word) | (packHalf2x16(vec2(above, 0.0)) << 16);
}

void main() {
  uvec2 pixel;
  if (!tile_pixel(pixel)) return;
  float opaque = texelFetch(depths, ivec2(pixel), 0).r;
  uvec2 found = uvec2(0u, packed_share(vec3(1.0)));
  if (kUnderWater) found.x = water_above(pixel, opaque);
  if (kGlass && opaque > 0.0) found.y = packed_share(share_through_glass(pixel_ray(pixel) * view_distance(opaque, frame.near_plane), vec3(0.0)));
  imageStore(media_light, ivec2(pixel), uvec4(found, 0u, 0u));
}
