// Which tiles of 8x8 pixels lamps reach, for passes that list those apart. Needs before the include: shared/frame.h.
#ifndef SKERRY_LIT_TILES_GLSL
#define SKERRY_LIT_TILES_GLSL
#include "shared/clusters.h"
#include "shared/light.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(constant_id = kLitConstant) const bool kLit = false;        // if not, buffers are bound that are never read
layout(constant_id = kOracleConstant) const bool kOracle = false;  // every lamp may reach every tile

layout(scalar, binding = kLightGridBinding) uniform Grid { ClusterGrid grid; };
layout(scalar, binding = kClustersBinding) readonly buffer Clusters { Cluster clusters[]; };
layout(scalar, binding = kTileDepthsBinding) readonly buffer LitDepths { TileDepths tile_depths[]; };  // of 8x8 pixels

#include "include/light/clusters.glsl"

// @param tile of 8x8 pixels. @param count of them across and down.
bool lamps_reach(uvec2 tile, uvec2 count) {
  if (!kLit || kOracle) return kLit;
  uint first = cluster_of(tile_at(tile * kTileEdge), 0u);
  bool reached = false;
  for (uint left = tile_depths[tile.y * count.x + tile.x].slices; left != 0u && !reached; left &= left - 1u)
    reached = clusters[first + uint(findLSB(left))].count != 0u;
  return reached;
}
#endif
