#version 460
#extension GL_GOOGLE_include_directive : require
// Sorts 8x8-pixel tiles into those with surfaces and those with open pixels (a tile may be both), so that each shader runs where it is
// needed only: lavapipe runs both sides of every branch, and on any device a tile's pixels then do the same. Where that is asked for, tiles with
// surfaces that lamps reach are in a list of their own. docs/conventions.md.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "include/scene/coverage.glsl"
#include "include/scene/layers.glsl"
#include "include/scene/list_tiles.glsl"
#include "include/light/lit_tiles.glsl"

layout(local_size_x = 64) in;

layout(binding = kSurfacesBinding, r32ui) readonly uniform uimage2D surfaces;
layout(binding = kDepthsBinding) uniform sampler2D depths;
// Pixels outside the area show no surface; tiles from first_tile on are looked at, others are in no list.
layout(push_constant) uniform Push { uvec4 area; uvec2 size; uvec2 tile_count; uvec2 first_tile; uvec2 looked_at; } push;

// One invocation a tile: no barriers, which lavapipe pays for dearly.
void main() {
  uint tile = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
  if (tile >= push.looked_at.x * push.looked_at.y) return;
  uvec2 at = push.first_tile + uvec2(tile % push.looked_at.x, tile / push.looked_at.x);
  ivec2 low = ivec2(at * kTileEdge), last = ivec2(push.size) - 1;
  bool covered = false, open = false;
  for (int y = 0; y < int(kTileEdge); ++y) {
    for (int x = 0; x < int(kTileEdge); ++x) {
      ivec2 pixel = min(low + ivec2(x, y), last);
      bool here = is_covered(imageLoad(surfaces, pixel).r, layer_depth_at(depths, pixel, push.area));
      covered = covered || here;
      open = open || !here;
    }
  }
  if (covered) list_tile(lamps_reach(at, push.tile_count) ? kLampTiles : 0u, at, push.tile_count);
  if (open) list_tile(1u, at, push.tile_count);
}
