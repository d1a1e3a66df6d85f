#version 460
#extension GL_GOOGLE_include_directive : require
// Step 2 of 3: where each group's draws begin; one work group a list, exclusive scan of the group totals in place, the sum becomes the list's
// draw count. Step 3: writes the indirect commands of every view and list, in section order. docs/conventions.md.
#include "include/scene/cull.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 256) in;

layout(scalar, binding = kSectionsBinding) readonly buffer Sections { Section sections[]; };
layout(scalar, binding = kCullMasksBinding) readonly buffer Masks { uint masks[]; };
layout(scalar, binding = kCullTotalsBinding) buffer Totals { uint group_offsets[]; };            // [view][list][group]
layout(scalar, binding = kCullViewsBinding) readonly buffer Views { CullView views[]; };
layout(scalar, binding = kDrawCommandsBinding) writeonly buffer Draws { DrawCommand draws[]; };  // [view][list][most]
layout(scalar, binding = kDrawCountsBinding) writeonly buffer Counts { uint draw_counts[]; };    // [view][list]
layout(scalar, push_constant) uniform Push { uint section_count; uint group_count; uvec3 most; } push;  // draws of each list

layout(constant_id = kScanConstant) const bool kScan = false;  // else commands are written

shared uint sums[256];

uint emit_run(uint section, uint first_quad, uint begin, uint end, uint list, uint slot) {
  uvec3 most = push.most;
  uint before = list == 0u ? 0u : list == 1u ? most.x : most.x + most.y;
  uint list_base = gl_GlobalInvocationID.y * (most.x + most.y + most.z) + before;
  for (; begin < end; begin += kMaxQuadsPerDraw, ++slot) {
    if (slot >= most[list]) return slot;
    uint quads = min(end - begin, kMaxQuadsPerDraw);
    draws[list_base + slot] = DrawCommand(6u * quads, 1u, 0u, 4u * (first_quad + begin), section);
  }
  return slot;
}

void emit() {
  uint section = gl_GlobalInvocationID.x;
  uint view = gl_GlobalInvocationID.y;
  uint lane = gl_LocalInvocationIndex;
  if (views[view].enabled == 0u) return;
  uint mask = 0u;
  Section s;
  if (section < push.section_count) {
    mask = masks[view * push.section_count + section];
    s = sections[section];
  }
  for (uint list = 0u; list < kListCount; ++list) {
    uint own = mask == 0u ? 0u : draw_count(s, mask, list);
    sums[lane] = own;
    barrier();
    for (uint step = 1u; step < 256u; step <<= 1) {
      uint other = lane >= step ? sums[lane - step] : 0u;
      barrier();
      sums[lane] += other;
      barrier();
    }
    if (own != 0u) {
      uint slot = group_offsets[(view * kListCount + list) * push.group_count + gl_WorkGroupID.x] + sums[lane] - own;
      uint begin = 0u, end = 0u;
      for (uint r = list_first_range(list); r < list_end_range(list); ++r) {
        uint b = range_begin(s, r), e = s.range_end[r];
        if ((mask & (1u << r)) == 0u || b == e) continue;
        if (b != end || begin == end) {
          slot = emit_run(section, s.first_quad, begin, end, list, slot);
          begin = b;
        }
        end = e;
      }
      emit_run(section, s.first_quad, begin, end, list, slot);
    }
    barrier();
  }
}

void scan() {
  uint list = gl_WorkGroupID.x;
  uint lane = gl_LocalInvocationIndex;
  uint base = list * push.group_count;
  uint carried = 0u;
  for (uint start = 0u; start < push.group_count; start += 256u) {
    uint i = start + lane;
    uint own = i < push.group_count ? group_offsets[base + i] : 0u;
    sums[lane] = own;
    barrier();
    for (uint step = 1u; step < 256u; step <<= 1) {
      uint other = lane >= step ? sums[lane - step] : 0u;
      barrier();
      sums[lane] += other;
      barrier();
    }
    if (i < push.group_count) group_offsets[base + i] = carried + sums[lane] - own;
    carried += sums[255];
    barrier();
  }
  if (lane == 0u) draw_counts[list] = min(carried, push.most[list % kListCount]);
}

void main() {
  if (kScan)
    scan();
  else
    emit();
}
