#version 460
#extension GL_GOOGLE_include_directive : require
// Sorts 8x8-pixel tiles into those with surfaces and those with open pixels (a tile may be both), so that each shader runs where it is
// needed only: lavapipe runs both sides of every branch, and on any device a tile's pixels then do the same. docs/conventions.md.
#include "include/common.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0, r32ui) readonly uniform uimage2D surfaces;
layout(scalar, binding = 1) buffer Dispatches { TileDispatch dispatches[2]; };  // 0 covered, 1 open
layout(scalar, binding = 2) writeonly buffer Tiles { uint tiles[]; };           // [kind][tile]
layout(push_constant) uniform Push { uvec2 size; } push;

shared uint seen;  // bit 0: a surface, bit 1: sky

void main() {
  if (gl_LocalInvocationIndex == 0u) seen = 0u;
  barrier();
  uvec2 pixel = gl_GlobalInvocationID.xy;
  bool inside = all(lessThan(pixel, push.size));
  uint word = imageLoad(surfaces, ivec2(min(pixel, push.size - 1u))).r;
  if (inside) atomicOr(seen, word != 0u ? 1u : 2u);
  barrier();
  uint kind = gl_LocalInvocationIndex;
  if (kind < 2u && (seen & (1u << kind)) != 0u) {
    uint slot = atomicAdd(dispatches[kind].tiles, 1u);
    atomicMax(dispatches[kind].groups_x, min(slot + 1u, kTileRow));
    atomicMax(dispatches[kind].groups_y, slot / kTileRow + 1u);
    uint count = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
    tiles[kind * count + slot] = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  }
}
