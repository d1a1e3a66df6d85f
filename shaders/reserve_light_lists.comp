#version 460
#extension GL_GOOGLE_include_directive : require
// Room for each occupied cluster's list. Where a list lies depends on timing; what it says does not. A list without room is all lights: more to
// ask, the same answer. docs/conventions.md.
#extension GL_EXT_scalar_block_layout : require
#include "shared/clusters.h"
#include "shared/frame.h"
#include "shared/bindings.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kLightGridBinding) uniform Grid { ClusterGrid grid; };
layout(scalar, binding = kClusterWorkBinding) buffer Work { ClusterWork work; };
layout(scalar, binding = kOccupiedClustersBinding) readonly buffer Occupied { uint occupied[]; };
layout(scalar, binding = kLightCountsBinding) buffer Counts { uint counts[]; };  // [slot][chunk]: of lights; becomes where the chunk's part of the list begins
layout(scalar, binding = kClustersBinding) writeonly buffer Clusters { Cluster clusters[]; };

void main() {
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
