#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the clusters that show something. Their order depends on timing; nothing else does. docs/conventions.md.
#include "include/common.glsl"
#include "shared/clusters.h"
#include "shared/bindings.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kLightGridBinding) uniform Grid { ClusterGrid grid; };
layout(scalar, binding = kTileDepthsBinding) readonly buffer Small { TileDepths small_tiles[]; };  // of 8x8 pixels
layout(scalar, binding = kGridTilesBinding) writeonly buffer Large { TileDepths tiles[]; };       // of the grid
layout(scalar, binding = kClusterWorkBinding) buffer Work { ClusterWork work; };
layout(scalar, binding = kOccupiedClustersBinding) writeonly buffer Occupied { uint occupied[]; };

#include "include/clusters.glsl"

void list_cluster(uint cluster) {
  uint slot = atomicAdd(work.clusters, 1u), group = slot / kClusterGroup;
  if (slot % kClusterGroup == 0u) {
    atomicMax(work.groups_x, min(group + 1u, kTileRow));
    if (group % kTileRow == 0u) atomicMax(work.groups_y, group / kTileRow + 1u);
  }
  occupied[slot] = cluster;
}

void main() {
  uint tile = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
  if (tile >= grid.tiles_x * grid.tiles_y) return;
  uint along = (1u << grid.edge_log2) / kTileEdge;  // small tiles along a large one
  uvec2 small_count = (grid.size + kTileEdge - 1u) / kTileEdge;
  uvec2 low = uvec2(tile % grid.tiles_x, tile / grid.tiles_x) * along;
  TileDepths t = TileDepths(0u, 1e30, 0.0);
  for (uint i = 0u; i < along * along; ++i) {
    uvec2 at = min(low + uvec2(i % along, i / along), small_count - 1u);
    TileDepths s = small_tiles[at.y * small_count.x + at.x];
    t.slices |= s.slices;
    t.nearest = min(t.nearest, s.nearest);
    t.farthest = max(t.farthest, s.farthest);
  }
  tiles[tile] = t;
  for (uint left = t.slices; left != 0u; left &= left - 1u) list_cluster(cluster_of(tile, uint(findLSB(left))));
}
