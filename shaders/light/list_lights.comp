#version 460
#extension GL_GOOGLE_include_directive : require
// The lists about lights, in four steps. Depths: those that each tile of 8x8 pixels shows, opaque and translucent. Clusters: those that show something. Room: for each occupied cluster's list; a list without room is all
// lights: more to ask, the same answer. Tiles: those of 8x8 pixels that some light reaches, for shade_lights. The order of clusters and tiles and
// where a list lies depend on timing; nothing else does. docs/conventions.md.
#include "include/frame/common.glsl"
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
layout(scalar, binding = kTileDepthsBinding) buffer Small { TileDepths small_tiles[]; };  // of 8x8 pixels
layout(scalar, binding = kGridTilesBinding) writeonly buffer Large { TileDepths tiles[]; };       // of the grid
layout(scalar, binding = kClusterWorkBinding) buffer Work { ClusterWork work; };
layout(scalar, binding = kOccupiedClustersBinding) buffer Occupied { uint occupied[]; };
layout(scalar, binding = kLightCountsBinding) buffer Counts { uint counts[]; };  // [slot][chunk]: of lights; becomes where the chunk's part of the list begins
layout(scalar, binding = kClustersBinding) buffer Clusters { Cluster clusters[]; };
layout(scalar, binding = kTileDispatchesBinding) buffer Dispatches { TileDispatch dispatch; };
layout(scalar, binding = kTilesBinding) writeonly buffer Tiles { uint listed_tiles[]; };

layout(constant_id = kLightListConstant) const uint kLightList = kListClusters;
layout(constant_id = kOracleConstant) const bool kOracle = false;  // every light may reach every tile
layout(constant_id = kWaterLayersConstant) const uint kWaterLayers = 0u;  // of translucent surfaces, 0..4

#include "include/light/clusters.glsl"
#include "include/scene/coverage.glsl"
#include "include/scene/layers.glsl"

void take(inout TileDepths t, float depth) {
  float z = view_distance(depth, grid.near_plane);
  t.slices |= 1u << slice_at(z);
  t.nearest = min(t.nearest, z);
  t.farthest = max(t.farthest, z);
}

// One invocation a tile: no barriers, which lavapipe pays for dearly.
void find_depths() {
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
      if (kWaterLayers > 0u && (depth = layer_depth_at(layer_depths_0, pixel, grid.layers_area)) > 0.0) take(t, depth);
      if (kWaterLayers > 1u && (depth = layer_depth_at(layer_depths_1, pixel, grid.layers_area)) > 0.0) take(t, depth);
      if (kWaterLayers > 2u && (depth = layer_depth_at(layer_depths_2, pixel, grid.layers_area)) > 0.0) take(t, depth);
      if (kWaterLayers > 3u && (depth = layer_depth_at(layer_depths_3, pixel, grid.layers_area)) > 0.0) take(t, depth);
    }
  }
  small_tiles[tile] = t;
}

void list_cluster(uint cluster) {
  uint slot = atomicAdd(work.clusters, 1u), group = slot / kClusterGroup;
  if (slot % kClusterGroup == 0u) {
    atomicMax(work.groups_x, min(group + 1u, kTileRow));
    if (group % kTileRow == 0u) atomicMax(work.groups_y, group / kTileRow + 1u);
  }
  occupied[slot] = cluster;
}

void list_clusters() {
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

void reserve_room() {
  uint slot = (gl_WorkGroupID.y * kTileRow + gl_WorkGroupID.x) * kClusterGroup + gl_LocalInvocationIndex;
  if (slot >= work.clusters || gl_WorkGroupID.z != 0u) return;
  uint count = 0u;
  for (uint chunk = 0u; chunk < grid.chunks; ++chunk) count += counts[slot * grid.chunks + chunk];
  Cluster mine = Cluster(0u, count);
  if (count != 0u) {
    uint units = ((count - 1u) >> grid.unit_log2) + 1u;
    uint begin = atomicAdd(work.units, units);
    bool fits = begin <= grid.capacity && units <= grid.capacity - begin;
    mine = fits ? Cluster(begin << grid.unit_log2, count) : Cluster(kAllLights, grid.light_count);
  }
  clusters[occupied[slot]] = mine;
  uint next = mine.first;
  for (uint chunk = 0u; chunk < grid.chunks; ++chunk) {
    uint here = counts[slot * grid.chunks + chunk];
    counts[slot * grid.chunks + chunk] = next;
    next += here;
  }
}

void list_tiles() {
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
  listed_tiles[slot] = tile;
}

void main() {
  if (kLightList == kListDepths)
    find_depths();
  else if (kLightList == kListClusters)
    list_clusters();
  else if (kLightList == kListRoom)
    reserve_room();
  else
    list_tiles();
}
