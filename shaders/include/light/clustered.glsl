// The lights of a pixel. Needs before the include: `frame` and what lights.glsl needs.
#ifndef SKERRY_CLUSTERED_GLSL
#define SKERRY_CLUSTERED_GLSL
#include "shared/clusters.h"
#include "shared/light.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(scalar, binding = kLightGridBinding) uniform Grid { ClusterGrid grid; };
layout(scalar, binding = kClustersBinding) readonly buffer Clusters { Cluster clusters[]; };
layout(scalar, binding = kLightEntriesBinding) readonly buffer Entries { uint entries[]; };

layout(constant_id = kOracleConstant) const bool kOracle = false;  // every pixel asks every light: the truth that clusters are held against

#include "include/light/light_texels.glsl"
#include "include/light/clusters.glsl"
#include "include/light/lights.glsl"

// @param z distance along the view axis of a surface that the pixel shows.
Cluster lights_at(uvec2 pixel, float z) {
  if (kOracle) return Cluster(kAllLights, grid.light_count);
  return clusters[cluster_of(tile_at(pixel), slice_at(z))];
}
uint light_index(Cluster c, uint i) {
  if (kOracle) return i;
  bool all = c.first == kAllLights;
  uint entry = entries[all ? 0u : c.first + i];
  return all ? i : entry;
}
#endif
