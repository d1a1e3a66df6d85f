#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_basic : require
// Lists the pixels at edges of surfaces. Reverse depth is linear in the picture on every plane, so that it bends at edges alone. A first step asks
// some pixels of each tile whether they lie on one plane, and lists the tiles where they do not; a second one asks each pixel of those. A list's order
// follows threads, what becomes of a pixel does not. docs/decisions/0043.
#include "include/frame/common.glsl"
#include "shared/edges.h"
#include "shared/bindings.h"
#include "shared/constants.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(scalar, binding = kTileDispatchesBinding) buffer Dispatches { TileDispatch dispatches[kEdgeDispatches]; };  // 0 tiles, 1 pixels, 2 a tile a group
layout(scalar, binding = kTilesBinding) buffer Tiles { uint tiles[]; };                              // x | y << 16
layout(scalar, binding = kEdgePixelsBinding) writeonly buffer Pixels { EdgePixel pixels[]; };
layout(push_constant) uniform Push { float bend; } push;  // of reverse depth, as a share of it: less is a plane

layout(constant_id = kEveryPixelConstant) const bool kEveryPixel = false;  // the second step

// Room in a list for `count` entries of each invocation. Every invocation calls it once. @param per_group entries that a group works on.
uint first_slot(uint list, uint count, uint per_group) {
  uint before = subgroupExclusiveAdd(count), all = subgroupAdd(count), first = 0u;
  if (all == 0u) return 0u;
  if (subgroupElect()) {
    first = atomicAdd(dispatches[list].tiles, all);
    uint groups = (first + all + per_group - 1u) / per_group;
    atomicMax(dispatches[list].groups_x, min(groups, kTileRow));
    atomicMax(dispatches[list].groups_y, (groups + kTileRow - 1u) / kTileRow);
  }
  return subgroupBroadcastFirst(first) + before;
}

#include "include/post/plane_tiles.glsl"

void list_tiles() {
  uvec2 count = (frame.size + (kTileEdge - 1u)) / kTileEdge;
  uint tile = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
  uvec2 at = uvec2(tile % count.x, tile / count.x);
  bool wanted = tile < count.x * count.y && !is_plane(ivec2(at * kTileEdge), push.bend);
  uint slot = first_slot(0u, uint(wanted), 64u / kEdgeParts), last = subgroupMax(wanted ? slot + 1u : 0u);
  if (subgroupElect() && last > 0u) {
    atomicMax(dispatches[2].groups_x, min(last, kTileRow));
    atomicMax(dispatches[2].groups_y, (last + kTileRow - 1u) / kTileRow);
  }
  if (wanted) tiles[slot] = at.x | (at.y << 16);
}

bvec4 bend(vec4 before, vec4 here, vec4 after) {
  return greaterThan(abs((before - here) + (after - here)), push.bend * max(max(before, after), here));
}

uint mask_of(bvec4 found) { return (found.x ? 1u : 0u) | (found.y ? 2u : 0u) | (found.z ? 4u : 0u) | (found.w ? 8u : 0u); }

float depth_at(int x, int y) { return texelFetch(depths, ivec2(x, y), 0).r; }
vec4 depths_at(ivec4 x, int y) { return vec4(depth_at(x.x, y), depth_at(x.y, y), depth_at(x.z, y), depth_at(x.w, y)); }

// Of four columns of a tile, a bit a pixel.
uint edges_from(ivec2 low) {
  ivec2 last = ivec2(frame.size) - 1;
  // At the picture's border there is no pixel beside to tell a bend by.
  ivec4 x = low.x + ivec4(0, 1, 2, 3), columns = min(x, ivec4(last.x));
  uint there = mask_of(lessThanEqual(x, ivec4(last.x)));
  uint inside = mask_of(lessThan(x, ivec4(last.x))) & (low.x > 0 ? 15u : 14u);
  int left = clamp(low.x - 1, 0, last.x), right = min(low.x + 4, last.x);
  vec4 before = depths_at(columns, clamp(low.y - 1, 0, last.y)), here = depths_at(columns, min(low.y, last.y));
  uint found = 0u;
  for (int row = 0; row < int(kTileEdge); ++row) {
    int y = low.y + row, now = min(y, last.y);
    vec4 after = depths_at(columns, min(y + 1, last.y));
    uint upright = y > 0 && y < last.y ? mask_of(bend(before, here, after)) : 0u;
    uint along = mask_of(bend(vec4(depth_at(left, now), here.xyz), here, vec4(here.yzw, depth_at(right, now)))) & inside;
    found |= (y <= last.y ? (upright | along) & there : 0u) << uint(row * 4);
    before = here;
    here = after;
  }
  return found;
}

void list_pixels() {
  uint part = (gl_WorkGroupID.y * kTileRow + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex, slot = part / kEdgeParts;
  bool here = slot < dispatches[0].tiles;
  uint tile = tiles[here ? slot : 0u];
  uvec2 low = uvec2(tile & 0xffffu, tile >> 16) * kTileEdge + uvec2(part % kEdgeParts * 4u, 0u);
  uint found = here ? edges_from(ivec2(low)) : 0u;
  slot = first_slot(1u, uint(bitCount(found)), 64u);
  for (; found != 0u; found &= found - 1u) {
    uint bit = uint(findLSB(found));
    pixels[slot++].place = (low.x + bit % 4u) | ((low.y + bit / 4u) << 16);
  }
}

void main() {
  if (kEveryPixel) {
    list_pixels();
  } else {
    list_tiles();
  }
}
