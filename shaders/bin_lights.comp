#version 460
#extension GL_GOOGLE_include_directive : require
// Which lights reach each coarse bin of tiles, a bit a light. One invocation asks 32 lights about one bin and writes one word: the result has the
// lights' order, without atomics, barriers or anything to clear. docs/conventions.md.
#extension GL_EXT_scalar_block_layout : require
#include "shared/clusters.h"
#include "shared/light.h"
#include "shared/bindings.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kLightGridBinding) uniform Grid { ClusterGrid grid; };
layout(scalar, binding = kLightsBinding) readonly buffer Lights { Light lights[]; };
layout(scalar, binding = kGridTilesBinding) readonly buffer Large { TileDepths tiles[]; };
layout(scalar, binding = kLightBinsBinding) writeonly buffer Bins { uint bins[]; };  // [bin][word]

#include "include/clusters.glsl"

void main() {
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
