#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Which lights reach what, in five steps. Depths: those that each tile of 8x8 pixels shows, opaque and translucent. Clusters: those that show
// something. Bins: of coarse bins of tiles, a bit a light; one invocation asks 32 lights about one bin and writes one word: the result has the
// lights' order, without atomics, barriers or anything to clear. Lists of occupied clusters, twice: first each invocation counts the lights of its
// chunk of the bin that reach the cluster, then, once there is room, it lists them in their order. Room: for each occupied cluster's list; a list
// without room is all lights: more to ask, the same answer. The order of clusters and where a list lies depend on timing; nothing else does.
// docs/conventions.md.
#include "include/frame/common.glsl"
#include "shared/clusters.h"
#include "shared/light.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kLightGridBinding) uniform Grid { ClusterGrid grid; };
#include "include/light/light_texels.glsl"
#include "include/frame/islands.glsl"
layout(scalar, binding = kLightReachBinding) readonly buffer Reaches { LightReach reaches[]; };  // if no light has one, a buffer that is never read
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kLayerDepthsBinding) uniform sampler2D layer_depths_0;
layout(binding = kLayerDepthsBinding + 1u) uniform sampler2D layer_depths_1;
layout(binding = kLayerDepthsBinding + 2u) uniform sampler2D layer_depths_2;
layout(binding = kLayerDepthsBinding + 3u) uniform sampler2D layer_depths_3;
layout(scalar, binding = kTileDepthsBinding) buffer Small { TileDepths small_tiles[]; };  // of 8x8 pixels
layout(scalar, binding = kGridTilesBinding) buffer Large { TileDepths tiles[]; };         // of the grid
layout(scalar, binding = kLightBinsBinding) buffer Bins { uint bins[]; };                 // [bin][word]
layout(scalar, binding = kClusterWorkBinding) buffer Work { ClusterWork work; };
layout(scalar, binding = kOccupiedClustersBinding) buffer Occupied { uint occupied[]; };
layout(scalar, binding = kLightCountsBinding) buffer Counts { uint counts[]; };  // [slot][chunk]: of lights; becomes where the chunk's part of the list begins
layout(scalar, binding = kClustersBinding) buffer Clusters { Cluster clusters[]; };
layout(scalar, binding = kLightEntriesBinding) writeonly buffer Entries { uint entries[]; };
layout(push_constant) uniform Push { uint list; } push;  // of kLightLists. 0: count, 1: list

layout(constant_id = kLightStepConstant) const uint kLightStep = kLightDepths;
layout(constant_id = kWaterLayersConstant) const uint kWaterLayers = 0u;  // of translucent surfaces, 0..4

#include "include/light/clusters.glsl"
#include "include/scene/coverage.glsl"
#include "include/scene/gather_depths.glsl"
#include "include/scene/layers.glsl"

void take(inout TileDepths t, float depth) {
  float z = view_distance(depth, grid.near_plane);
  t.slices |= 1u << slice_at(z);
  t.nearest = min(t.nearest, z);
  t.farthest = max(t.farthest, z);
}

float opaque_depth(float depth, uvec2 pixel) {
  bool here = kDepth16 && imageLoad(surfaces, ivec2(min(pixel, grid.size - 1u))).r != 0u;
  return here ? max(depth, 0.5 / 65535.0) : depth;
}
// Reverse depths of opaque surfaces at four pixels, 0 where there is none.
vec4 opaque_depths(uvec2 low) {
  vec4 d = depths_about(ivec2(low), grid.size);
  return vec4(opaque_depth(d.x, low + uvec2(0u, 1u)), opaque_depth(d.y, low + 1u), opaque_depth(d.z, low + uvec2(1u, 0u)), opaque_depth(d.w, low));
}

uint slice_of(float depth) { return depth > 0.0 ? 1u << slice_at(view_distance(depth, grid.near_plane)) : 0u; }

// One invocation a tile: no barriers, which lavapipe pays for dearly.
void find_depths() {
  uvec2 count = (grid.size + kTileEdge - 1u) / kTileEdge;
  uint tile = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
  if (tile >= count.x * count.y) return;
  ivec2 low = ivec2(tile % count.x, tile / count.x) * int(kTileEdge);
  TileDepths t = TileDepths(grid.marked_slices, 1e30, 0.0);
  if (grid.marked_slices != 0u) t = TileDepths(grid.marked_slices, 0.0, slice_begin(uint(findMSB(grid.marked_slices)) + 1u));
  float nearest = 1e30, farthest = 0.0;
  [[unroll]] for (uint i = 0u; i < kTileEdge * kTileEdge / 4u; ++i) {
    vec4 d = opaque_depths(uvec2(low) + 2u * uvec2(i % (kTileEdge / 2u), i / (kTileEdge / 2u)));
    vec4 z = grid.near_plane / d;
    nearest = min(nearest, least_of(mix(vec4(1e30), z, greaterThan(d, vec4(0.0)))));
    farthest = max(farthest, most_of(mix(vec4(0.0), z, greaterThan(d, vec4(0.0)))));
  }
  t.nearest = min(t.nearest, nearest);
  t.farthest = max(t.farthest, farthest);
  uint first_slice = slice_at(nearest), last_slice = slice_at(farthest);
  bool some = farthest > 0.0;
  if (some) t.slices |= (1u << first_slice) | (1u << last_slice);
  // A second look where others may lie between: a loop, which lavapipe leaves where no tile needs it.
  uint gathers = some && last_slice > first_slice + 1u ? kTileEdge * kTileEdge / 4u : 0u;
  for (uint i = 0u; i < gathers; ++i) {
    vec4 d = opaque_depths(uvec2(low) + 2u * uvec2(i % (kTileEdge / 2u), i / (kTileEdge / 2u)));
    t.slices |= slice_of(d.x) | slice_of(d.y) | slice_of(d.z) | slice_of(d.w);
  }
  if (kWaterLayers > 0u) {
    // A loop of its own, over what shows layers at all: lavapipe skips a loop that ends, never a branch.
    ivec2 first = max(low, ivec2(grid.layers_area.xy)), end = min(min(low + int(kTileEdge), ivec2(grid.layers_area.zw)), ivec2(grid.size));
    for (int y = first.y; y < end.y && first.x < end.x; ++y) {
      for (int x = first.x; x < end.x; ++x) {
        ivec2 pixel = ivec2(x, y);
        float depth = texelFetch(layer_depths_0, pixel, 0).r;
        if (depth > 0.0) take(t, depth);
        if (kWaterLayers > 1u && (depth = texelFetch(layer_depths_1, pixel, 0).r) > 0.0) take(t, depth);
        if (kWaterLayers > 2u && (depth = texelFetch(layer_depths_2, pixel, 0).r) > 0.0) take(t, depth);
        if (kWaterLayers > 3u && (depth = texelFetch(layer_depths_3, pixel, 0).r) > 0.0) take(t, depth);
      }
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

// Whether walls let a light arrive at what a cell shows, as far as that is known. Errs on the side of yes.
bool arrives_in(uint index, vec3 middle, vec3 half_size) {
  if (index == 0u) return true;
  ivec3 first = reaches[index - 1u].low, size = reaches[index - 1u].size;
  float per_block = reaches[index - 1u].per_block;
  IslandTransform t = island_at(reaches[index - 1u].island);
  vec3 at = middle - t.translation;
  vec3 centre = vec3(dot(t.axis_x, at), dot(t.axis_y, at), dot(t.axis_z, at));
  vec3 around = vec3(dot(abs(t.axis_x), half_size), dot(abs(t.axis_y), half_size), dot(abs(t.axis_z), half_size));
  around += 0.01 + 1e-4 * (abs(middle.x) + abs(middle.y) + abs(middle.z));  // rounding
  ivec3 low = max(ivec3(floor((centre - around) * per_block)) - first, 0);
  ivec3 high = min(ivec3(floor((centre + around) * per_block)) - first, size - 1);
  if (any(greaterThan(low, high))) return false;
  // Bits along z stand together: a word at a time.
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      uint row = uint(size.z * (x + size.x * y)), first_bit = row + uint(low.z), last_bit = row + uint(high.z);
      for (uint word = first_bit >> 5; word <= last_bit >> 5; ++word) {
        uint from = max(first_bit, word * 32u) & 31u, to = min(last_bit, word * 32u + 31u) & 31u;
        uint mask = (0xffffffffu << from) & (0xffffffffu >> (31u - to));
        if ((reaches[index - 1u].bits[word] & mask) != 0u) return true;
      }
    }
  return false;
}

void fill_bin() {
  uint bin = gl_GlobalInvocationID.x, word = gl_WorkGroupID.y;
  if (bin >= grid.bins_x * grid.bins_y) return;
  uvec2 at = uvec2(bin % grid.bins_x, bin / grid.bins_x);
  float nearest = 1e30, farthest = 0.0;
  for (uint i = 0u; i < kBinClusters * kBinClusters; ++i) {
    uvec2 tile = min(at * kBinClusters + uvec2(i % kBinClusters, i / kBinClusters), uvec2(grid.tiles_x, grid.tiles_y) - 1u);
    TileDepths t = tiles[tile.y * grid.tiles_x + tile.x];
    nearest = min(nearest, t.nearest);
    farthest = max(farthest, t.farthest);
  }
  uint bits = 0u;
  if (nearest <= farthest) {
    uint edge = kBinClusters << grid.edge_log2;  // pixels
    Cell cell = cell_of(at * edge, min((at + 1u) * edge, grid.size), nearest, farthest);
    uint end = min(word * 32u + 32u, grid.light_count);
    // A wider margin than a cluster's: what reaches a cluster must reach its bin.
    for (uint i = word * 32u; i < end; ++i)
      if (light_reaches(frame_light(i), cell, 1e-4)) bits |= 1u << (i & 31u);
  }
  bins[bin * grid.light_words + word] = bits;
}

void list_lights() {
  uint slot = (gl_WorkGroupID.y * kTileRow + gl_WorkGroupID.x) * kClusterGroup + gl_LocalInvocationIndex, chunk = gl_WorkGroupID.z;
  if (slot >= work.clusters) return;
  uint id = occupied[slot], tile = id / kClusterSlices, slice = id % kClusterSlices;
  uvec2 at = uvec2(tile % grid.tiles_x, tile / grid.tiles_x);
  TileDepths t = tiles[tile];
  float far = slice + 1u < kClusterSlices ? min(t.farthest, slice_begin(slice + 1u)) : t.farthest;
  Cell cell = cell_of(at << grid.edge_log2, min((at + 1u) << grid.edge_log2, grid.size), max(t.nearest, slice_begin(slice)), far);
  vec3 low, high;
  world_bounds(cell, low, high);
  vec3 middle = 0.5 * (low + high), half_size = 0.5 * (high - low);
  uint bin = (at.y / kBinClusters * grid.bins_x + at.x / kBinClusters) * grid.light_words;
  uint place = slot * grid.chunks + chunk;
  bool write = push.list != 0u;
  if (write && clusters[id].first == kAllLights) return;
  uint first = write ? counts[place] : 0u, count = 0u;
  uint end = min((chunk + 1u) * grid.chunk_words, grid.light_words);
  for (uint word = chunk * grid.chunk_words; word < end; ++word) {
    for (uint bits = bins[bin + word]; bits != 0u; bits &= bits - 1u) {
      uint index = word * 32u + uint(findLSB(bits));
      Light light = frame_light(index);
      if (!light_reaches(light, cell, 1e-5) || !arrives_in(light.reach, middle, half_size)) continue;
      if (write) entries[first + count] = index;
      ++count;
    }
  }
  if (!write) counts[place] = count;
}

void main() {
  if (kLightStep == kLightDepths)
    find_depths();
  else if (kLightStep == kLightClusters)
    list_clusters();
  else if (kLightStep == kLightBins)
    fill_bin();
  else if (kLightStep == kLightLists)
    list_lights();
  else
    reserve_room();
}
