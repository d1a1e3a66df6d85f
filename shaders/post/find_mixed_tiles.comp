#version 460
#extension GL_GOOGLE_include_directive : require
// Sorts 8x8-pixel tiles by how their pixels are mixed with those of the last frame (mix_frames.comp): what shows one plane alone, and has not
// changed, needs none of its neighbours. docs/decisions/0048.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"
#include "shared/temporal.h"

layout(local_size_x = 64) in;

layout(scalar, binding = kFrameBinding) uniform Frame { FrameConstants frame; };
layout(binding = kDepthsBinding) uniform sampler2D depths;
layout(scalar, binding = kTileDispatchesBinding) buffer Dispatches { TileDispatch dispatches[2]; };  // 0 edges, 1 planes
layout(scalar, binding = kTilesBinding) writeonly buffer Tiles { uint tiles[]; };                    // [kind][tile]: x | y << 16
layout(push_constant, scalar) uniform Push { TemporalStep step; } push;

layout(constant_id = kTranslucentConstant) const bool kTranslucent = false;  // there is water or glass
layout(constant_id = kCloudLayerConstant) const bool kClouds = false;        // there are clouds before the sky

#include "include/post/plane_tiles.glsl"

bool touches(uvec2 low, uvec4 area) { return all(lessThan(low, area.zw)) && all(greaterThan(low + kTileEdge, area.xy)); }

void main() {
  uvec2 count = (frame.size + (kTileEdge - 1u)) / kTileEdge;
  uint tile = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
  if (tile >= count.x * count.y) return;
  uvec2 at = uvec2(tile % count.x, tile / count.x), low = at * kTileEdge;
  bool plane = push.step.kept != 0u && is_plane(ivec2(low), push.step.bend) && !touches(low, push.step.changed_area);
  plane = plane && !(kTranslucent && touches(low, frame.layers_area));
  plane = plane && !(kClouds && sample_at(ivec2(low)).depth == 0.0);
  uint kind = plane ? 1u : 0u, slot = atomicAdd(dispatches[kind].tiles, 1u);
  atomicMax(dispatches[kind].groups_x, min(slot + 1u, kTileRow));
  if (slot % kTileRow == 0u) atomicMax(dispatches[kind].groups_y, slot / kTileRow + 1u);
  tiles[kind * count.x * count.y + slot] = at.x | (at.y << 16);
}
