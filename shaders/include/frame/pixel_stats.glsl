// Counts over the picture's pixels. Needs before the include: `stats` (PixelStats).
#ifndef SKERRY_PIXEL_STATS_GLSL
#define SKERRY_PIXEL_STATS_GLSL
#include "shared/constants.h"

// False in play, where nobody sees the counts: an atomic takes lavapipe a loop over its lanes, whether any of them takes part or not.
layout(constant_id = kCountPixelsConstant) const bool kCountPixels = true;

void count_non_finite(bool some) {
  if (kCountPixels && some) atomicAdd(stats.non_finite, 1u);
}
#endif
