#version 460
#extension GL_GOOGLE_include_directive : require
// Step 2 of 3: where each group's draws begin. One work group a list; exclusive scan of the group totals in place, the sum becomes
// the list's draw count. docs/conventions.md.
#include "include/cull.glsl"
#include "shared/bindings.h"

layout(local_size_x = 256) in;

layout(scalar, binding = kCullTotalsBinding) buffer Totals { uint group_totals[]; };        // [view][list][group]
layout(scalar, binding = kDrawCountsBinding) writeonly buffer Counts { uint draw_counts[]; }; // [view][list]
layout(push_constant) uniform Push { uint group_count; uint max_draws; } push;

shared uint sums[256];

void main() {
  uint list = gl_WorkGroupID.x;
  uint lane = gl_LocalInvocationIndex;
  uint base = list * push.group_count;
  uint carried = 0u;
  for (uint start = 0u; start < push.group_count; start += 256u) {
    uint i = start + lane;
    uint own = i < push.group_count ? group_totals[base + i] : 0u;
    sums[lane] = own;
    barrier();
    for (uint step = 1u; step < 256u; step <<= 1) {
      uint other = lane >= step ? sums[lane - step] : 0u;
      barrier();
      sums[lane] += other;
      barrier();
    }
    if (i < push.group_count) group_totals[base + i] = carried + sums[lane] - own;
    carried += sums[255];
    barrier();
  }
  if (lane == 0u) draw_counts[list] = min(carried, push.max_draws);
}
