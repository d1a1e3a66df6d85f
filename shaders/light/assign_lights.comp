#version 460
#extension GL_GOOGLE_include_directive : require
// Which lights reach what, in two steps. Bins: of coarse bins of tiles, a bit a light; one invocation asks 32 lights about one bin and writes one
// word: the result has the lights' order, without atomics, barriers or anything to clear. Lists of occupied clusters: two runs of the same
// instructions with reserve_light_lists between them: first each invocation counts the lights of its chunk of the bin that reach the cluster,
// then it lists them in their order. docs/conventions.md.
#extension GL_EXT_scalar_block_layout : require
#include "shared/clusters.h"
#include "shared/frame.h"
#include "shared/geometry.h"
#include "shared/light.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kLightGridBinding) uniform Grid { ClusterGrid grid; };
layout(scalar, binding = kLightsBinding) readonly buffer Lights { Light lights[]; };
layout(scalar, binding = kIslandsBinding) uniform Islands { IslandTransform islands[kMaxIslands]; };
layout(scalar, binding = kLightReachBinding) readonly buffer Reaches { LightReach reaches[]; };  // if no light has one, a buffer that is never read
layout(scalar, binding = kGridTilesBinding) readonly buffer Large { TileDepths tiles[]; };
layout(scalar, binding = kLightBinsBinding) buffer Bins { uint bins[]; };  // [bin][word]
layout(scalar, binding = kClusterWorkBinding) readonly buffer Work { ClusterWork work; };
layout(scalar, binding = kOccupiedClustersBinding) readonly buffer Occupied { uint occupied[]; };
layout(scalar, binding = kLightCountsBinding) buffer Counts { uint counts[]; };  // [slot][chunk]; in the second run where the chunk's part of the list begins
layout(scalar, binding = kClustersBinding) readonly buffer Clusters { Cluster clusters[]; };
layout(scalar, binding = kLightEntriesBinding) writeonly buffer Entries { uint entries[]; };
layout(push_constant) uniform Push { uint list; } push;  // 0: count, 1: list

layout(constant_id = kBinConstant) const bool kBin = false;  // the first step

#include "include/light/clusters.glsl"

// Whether walls let a light arrive at what a cell shows, as far as that is known. Errs on the side of yes.
bool arrives_in(uint index, vec3 middle, vec3 half_size) {
  if (index == 0u) return true;
  ivec3 first = reaches[index - 1u].low, size = reaches[index - 1u].size;
  float per_block = reaches[index - 1u].per_block;
  IslandTransform t = islands[reaches[index - 1u].island];
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
      if (light_reaches(lights[i], cell, 1e-4)) bits |= 1u << (i & 31u);
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
      uint light = word * 32u + uint(findLSB(bits));
      if (!light_reaches(lights[light], cell, 1e-5) || !arrives_in(lights[light].reach, middle, half_size)) continue;
      if (write) entries[first + count] = light;
      ++count;
    }
  }
  if (!write) counts[place] = count;
}

void main() {
  if (kBin)
    fill_bin();
  else
    list_lights();
}
