#version 460
#extension GL_GOOGLE_include_directive : require
// What stained glass leaves of the light of frame.glass_body on its way to the surfaces of each layer, as packed_share(), in the layers of words behind
// those that have surfaces; and last, to the medium before the eye. docs/decisions/0090.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
#include "include/frame/islands.glsl"
layout(scalar, binding = kMaterialsBinding) uniform Materials { Material materials[kMaxMaterials]; };
layout(binding = kGlassMapsBinding) uniform usampler2DArray glass_lists;
layout(binding = kShadowMapsBinding) uniform sampler2DArray shadow_maps;
layout(binding = kLayerSurfacesBinding, r32ui) uniform uimage2DArray layer_surfaces;
layout(binding = kLayerDepthsBinding) uniform sampler2D layer_depths_0;
layout(binding = kLayerDepthsBinding + 1u) uniform sampler2D layer_depths_1;
layout(binding = kLayerDepthsBinding + 2u) uniform sampler2D layer_depths_2;
layout(binding = kLayerDepthsBinding + 3u) uniform sampler2D layer_depths_3;

layout(constant_id = kWaterLayersConstant) const uint kWaterLayers = 3u;
layout(constant_id = kUnderWaterConstant) const bool kEyeInMedium = false;

#include "include/scene/layers.glsl"
#include "include/scene/tiles.glsl"
#include "include/surface/media.glsl"
#include "include/surface/packed_share.glsl"
#include "include/light/glass_lists.glsl"

float layer_depth(uint k, ivec2 pixel) {
  if (k == 0u) return layer_depth_at(layer_depths_0, pixel, frame.layers_area);
  if (k == 1u) return layer_depth_at(layer_depths_1, pixel, frame.layers_area);
  return k == 2u ? layer_depth_at(layer_depths_2, pixel, frame.layers_area) : layer_depth_at(layer_depths_3, pixel, frame.layers_area);
}

void main() {
  uvec2 at;
  if (!tile_pixel(at)) return;
  ivec2 pixel = ivec2(at);
  vec3 ray = pixel_ray(at);
  for (uint k = 0u; k < kWaterLayers; ++k) {
    float z = layer_depth(k, pixel);
    if (z <= 0.0) break;
    uint word = imageLoad(layer_surfaces, ivec3(pixel, k)).r;
    vec3 n = world_from_lattice_vector(island_at(surface_island(word)), face_normal(surface_face(word)));
    vec3 share = share_through_glass(ray * view_distance(z, frame.near_plane), n);
    imageStore(layer_surfaces, ivec3(pixel, kWaterLayers + k), uvec4(packed_share(share)));
  }
  if (kEyeInMedium)
    imageStore(layer_surfaces, ivec3(pixel, 2u * kWaterLayers), uvec4(packed_share(share_through_glass(normalize(ray) * 0.5, vec3(0.0)))));
}
