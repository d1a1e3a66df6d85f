#version 460
#extension GL_GOOGLE_include_directive : require
// Step 3 of 3: writes the indirect commands of every view and list, in section order. docs/conventions.md.
#include "include/cull.glsl"
#include "shared/bindings.h"

layout(local_size_x = 256) in;

layout(scalar, binding = kSectionsBinding) readonly buffer Sections { Section sections[]; };
layout(scalar, binding = kCullMasksBinding) readonly buffer Masks { uint masks[]; };
layout(scalar, binding = kCullTotalsBinding) readonly buffer Totals { uint group_offsets[]; };
layout(scalar, binding = kCullViewsBinding) readonly buffer Views { CullView views[]; };
layout(scalar, binding = kDrawCommandsBinding) writeonly buffer Draws { DrawCommand draws[]; };  // [view][list][max_draws]
layout(push_constant) uniform Push { uint section_count; uint group_count; uint max_draws; } push;

shared uint sums[256];

uint emit_run(uint section, uint first_quad, uint begin, uint end, uint list_base, uint slot) {
  for (; begin < end; begin += kMaxQuadsPerDraw, ++slot) {
    if (slot >= push.max_draws) return slot;
    uint quads = min(end - begin, kMaxQuadsPerDraw);
    draws[list_base + slot] = DrawCommand(6u * quads, 1u, 0u, 4u * (first_quad + begin), section);
  }
  return slot;
}

void main() {
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
      uint list_base = (view * kListCount + list) * push.max_draws;
      uint begin = 0u, end = 0u;
      for (uint r = list_first_range(list); r < list_end_range(list); ++r) {
        uint b = range_begin(s, r), e = s.range_end[r];
        if ((mask & (1u << r)) == 0u || b == e) continue;
        if (b != end || begin == end) {
          slot = emit_run(section, s.first_quad, begin, end, list_base, slot);
          begin = b;
        }
        end = e;
      }
      emit_run(section, s.first_quad, begin, end, list_base, slot);
    }
    barrier();
  }
}
