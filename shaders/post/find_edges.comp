#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
// Lists the pixels at edges of surfaces. Reverse depth is linear in the picture on every plane, so that it bends at edges alone. A list's order
// follows threads, what becomes of a pixel does not. docs/decisions/0043.
#include "include/frame/common.glsl"
#include "shared/edges.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(scalar, binding = kListedBinding) buffer Listed { TileDispatch listed; };
layout(scalar, binding = kEdgePixelsBinding) writeonly buffer Pixels { EdgePixel pixels[]; };
layout(push_constant) uniform Push { float bend; } push;  // of reverse depth, as a share of it: less is a plane

bvec4 bend(vec4 before, vec4 here, vec4 after) {
  return greaterThan(abs((before - here) + (after - here)), push.bend * max(max(before, after), here));
}

// Four depths of two rows, and of the pixels beside them.
struct Rows {
  vec4 upper, lower;
  vec2 left, right;  // x of the upper row, y of the lower one
};

Rows rows_at(vec2 corner, vec2 texel) {
  vec4 a = textureGather(depths, corner), b = textureGather(depths, corner + vec2(2.0 * texel.x, 0.0)), c = textureGather(depths, corner + vec2(4.0 * texel.x, 0.0));
  return Rows(vec4(a.z, b.wz, c.w), vec4(a.y, b.xy, c.x), a.wx, c.zy);
}

bvec4 bends_along(vec4 row, float left, float right) { return bend(vec4(left, row.xyz), row, vec4(row.yzw, right)); }

uint mask_of(bvec4 found) { return uint(found.x) | (uint(found.y) << 1) | (uint(found.z) << 2) | (uint(found.w) << 3); }

void list_pixels(uvec2 low, uint found) {
  uint count = bitCount(found), before = subgroupExclusiveAdd(count), all = subgroupAdd(count), first = 0u;
  if (all == 0u) return;
  if (subgroupElect()) {
    first = atomicAdd(listed.tiles, all);
    uint groups = (first + all + 63u) / 64u;
    atomicMax(listed.groups_x, min(groups, kTileRow));
    atomicMax(listed.groups_y, (groups + kTileRow - 1u) / kTileRow);
  }
  first = subgroupBroadcastFirst(first) + before;
  for (; found != 0u; found &= found - 1u) {
    uint bit = uint(findLSB(found));
    pixels[first++].place = (low.x + bit % kEdgeColumns) | ((low.y + bit / kEdgeColumns) << 16);
  }
}

void main() {
  ivec2 low = ivec2(gl_GlobalInvocationID.xy * uvec2(kEdgeColumns, kEdgeRows)), last = ivec2(frame.size) - 1;
  vec2 texel = 1.0 / vec2(frame.size);
  // At the picture's border there is no pixel beside to tell a bend by.
  ivec4 x = low.x + ivec4(0, 1, 2, 3);
  uint there = mask_of(lessThanEqual(x, ivec4(last.x)));
  uint inside = mask_of(lessThan(x, ivec4(last.x))) & (low.x > 0 ? 15u : 14u);
  uint found = 0u, along = 0u;  // along: what bends in the row before those that follow
  vec4 before = vec4(0.0), row = vec4(0.0);
  for (int y = -1; y < int(kEdgeRows) + 1; y += 2) {
    Rows next = rows_at(vec2(low.x, low.y + y + 1) * texel, texel);
    int above = low.y + y - 1;  // this row and the next one are known on all sides now
    uint first = (above > 0 && above < last.y ? mask_of(bend(before, row, next.upper)) : 0u) | along;
    uint second = (above >= 0 && above + 1 < last.y ? mask_of(bend(row, next.upper, next.lower)) : 0u) |
                  (mask_of(bends_along(next.upper, next.left.x, next.right.x)) & inside);
    if (y > 0 && above <= last.y) found |= (first & there) << uint((y - 1) * int(kEdgeColumns));
    if (y > 0 && y < int(kEdgeRows) && above < last.y) found |= (second & there) << uint(y * int(kEdgeColumns));
    along = mask_of(bends_along(next.lower, next.left.y, next.right.y)) & inside;
    before = next.upper;
    row = next.lower;
  }
  list_pixels(uvec2(low), found);
}
