// Counts over the picture's pixels. Needs before the include: `stats` (PixelStats).
#ifndef SKERRY_PIXEL_STATS_GLSL
#define SKERRY_PIXEL_STATS_GLSL
#extension GL_KHR_shader_subgroup_ballot : require
#include "shared/constants.h"

// False in play, where nobody sees the counts: an atomic takes lavapipe a loop over its lanes, whether any of them takes part or not.
layout(constant_id = kCountPixelsConstant) const bool kCountPixels = true;

void count_non_finite(bool some) {
  if (kCountPixels && some) atomicAdd(stats.non_finite, 1u);
}

// Of pixels that are black before tone mapping. Every invocation calls this once a pixel. @param counted it has been counted as black before.
void count_black(bool black, bool counted) {
  if (!kCountPixels) return;
  uint count = subgroupBallotBitCount(subgroupBallot(black)) - subgroupBallotBitCount(subgroupBallot(counted));
  if (count != 0u && subgroupElect()) atomicAdd(stats.black, count);
}
#endif
