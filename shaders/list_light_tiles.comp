#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the 8x8-pixel tiles that some light reaches, for shade_lights. docs/conventions.md.
#include "include/common.glsl"
#include "shared/clusters.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kLightGridBinding) uniform Grid { ClusterGrid grid; };
layout(scalar, binding = kTileDepthsBinding) readonly buffer Small { TileDepths small_tiles[]; };
layout(scalar, binding = kClustersBinding) readonly buffer Clusters { Cluster clusters[]; };
layout(scalar, binding = kTileDispatchesBinding) buffer Dispatches { TileDispatch dispatch; };
layout(scalar, binding = kTilesBinding) writeonly buffer Tiles { uint tiles[]; };

layout(constant_id = kOracleConstant) const bool kOracle = false;  // every light may reach every tile

#include "include/clusters.glsl"

void main() {
  uvec2 count = (grid.size + kTileEdge - 1u) / kTileEdge;
  uint tile = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
  if (tile >= count.x * count.y) return;
  uint first = cluster_of(tile_at(uvec2(tile % count.x, tile / count.x) * kTileEdge), 0u);
  bool lit = false;
  for (uint left = small_tiles[tile].slices; left != 0u && !lit; left &= left - 1u)
    lit = kOracle || clusters[first + uint(findLSB(left))].count != 0u;
  if (!lit) return;
  uint slot = atomicAdd(dispatch.tiles, 1u);
  atomicMax(dispatch.groups_x, min(slot + 1u, kTileRow));
  if (slot % kTileRow == 0u) atomicMax(dispatch.groups_y, slot / kTileRow + 1u);
  tiles[slot] = tile;
}
