#version 460
#extension GL_GOOGLE_include_directive : require
// What depths each 8x8-pixel tile shows, opaque and translucent, so that lights are sorted into clusters that show something only.
// docs/conventions.md.
#include "include/common.glsl"
#include "shared/clusters.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kLightGridBinding) uniform Grid { ClusterGrid grid; };
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kLayerDepthsBinding) uniform sampler2D layer_depths_0;
layout(binding = kLayerDepthsBinding + 1u) uniform sampler2D layer_depths_1;
layout(binding = kLayerDepthsBinding + 2u) uniform sampler2D layer_depths_2;
layout(binding = kLayerDepthsBinding + 3u) uniform sampler2D layer_depths_3;
layout(scalar, binding = kTileDepthsBinding) writeonly buffer TilesOut { TileDepths tiles[]; };

layout(constant_id = kWaterLayersConstant) const uint kWaterLayers = 0u;       // of translucent surfaces, 0..4
layout(constant_id = kDepth16Constant) const bool kDepth16 = false;  // what lies farthest then has depth 0, and only its word distinguishes it from the sky

#include "include/clusters.glsl"

void take(inout TileDepths t, float depth) {
  float z = view_distance(depth, grid.near_plane);
  t.slices |= 1u << slice_at(z);
  t.nearest = min(t.nearest, z);
  t.farthest = max(t.farthest, z);
}

// One invocation a tile: no barriers, which lavapipe pays for dearly.
void main() {
  uvec2 count = (grid.size + kTileEdge - 1u) / kTileEdge;
  uint tile = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
  if (tile >= count.x * count.y) return;
  ivec2 low = ivec2(tile % count.x, tile / count.x) * int(kTileEdge), last = ivec2(grid.size) - 1;
  TileDepths t = TileDepths(grid.marked_slices, 1e30, 0.0);
  if (grid.marked_slices != 0u) t = TileDepths(grid.marked_slices, 0.0, slice_begin(uint(findMSB(grid.marked_slices)) + 1u));
  for (int y = 0; y < int(kTileEdge); ++y) {
    for (int x = 0; x < int(kTileEdge); ++x) {
      ivec2 pixel = min(low + ivec2(x, y), last);
      float depth = texelFetch(depths, pixel, 0).r;
      if (kDepth16 && imageLoad(surfaces, pixel).r != 0u) depth = max(depth, 0.5 / 65535.0);
      if (depth > 0.0) take(t, depth);
      if (kWaterLayers > 0u && (depth = texelFetch(layer_depths_0, pixel, 0).r) > 0.0) take(t, depth);
      if (kWaterLayers > 1u && (depth = texelFetch(layer_depths_1, pixel, 0).r) > 0.0) take(t, depth);
      if (kWaterLayers > 2u && (depth = texelFetch(layer_depths_2, pixel, 0).r) > 0.0) take(t, depth);
      if (kWaterLayers > 3u && (depth = texelFetch(layer_depths_3, pixel, 0).r) > 0.0) take(t, depth);
    }
  }
  tiles[tile] = t;
}
