#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the tiles of bloom's first level that look at anything too bright: in most pictures a tenth of them. docs/exposure.md.
#include "include/frame/common.glsl"
#include "shared/bindings.h"
#include "shared/bloom.h"
#include "shared/exposure.h"

layout(local_size_x = 64) in;

layout(binding = kFineBloomBinding, rgba16f) readonly uniform image2D fine;
layout(scalar, binding = kExposureBinding) uniform Chosen { Exposure exposure; };
layout(scalar, binding = kTileDispatchesBinding) buffer Dispatches { TileDispatch dispatches[]; };
layout(scalar, binding = kTilesBinding) writeonly buffer Tiles { uint tiles[]; };  // x | y << 16
layout(push_constant) uniform Push { BloomStep step; } push;

#include "include/post/too_bright.glsl"

// One invocation a tile of 8x8 coarser texels, which look at 20x20.
void main() {
  uvec2 count = (push.step.coarse_size + 7u) / 8u;
  uint tile = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
  if (tile >= count.x * count.y) return;
  uvec2 at = uvec2(tile % count.x, tile / count.x);
  ivec2 first = max(ivec2(at * 16u) - 2, ivec2(0)), last = min(ivec2(at * 16u) + 18, ivec2(push.step.fine_size)) - 1;
  float brightest = 0.0;
  for (int y = first.y; y <= last.y && !over_knee(brightest, push.step.threshold); ++y)
    for (int x = first.x; x <= last.x; ++x)
      brightest = max(brightest, brightest_of(exposed_for_bloom(imageLoad(fine, ivec2(x, y)).rgb)));
  if (!over_knee(brightest, push.step.threshold)) return;
  uint slot = atomicAdd(dispatches[0].tiles, 1u);
  uint group = slot / 8u;  // each takes eight
  atomicMax(dispatches[0].groups_x, min(group + 1u, kTileRow));
  if (slot % (8u * kTileRow) == 0u) atomicMax(dispatches[0].groups_y, group / kTileRow + 1u);
  tiles[slot] = at.x | (at.y << 16);
}
