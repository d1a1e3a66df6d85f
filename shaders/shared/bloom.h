// Light that spreads in the eye and the lens: a pyramid of ever smaller pictures of what is too
// bright. docs/exposure.md.
#ifndef SKERRY_SHARED_BLOOM_H
#define SKERRY_SHARED_BLOOM_H
#include "types.h"
SHARED_BEGIN

SHARED_CONST uint kMaxBloomLevels = 8u;
// Of what reaches a level of the pyramid, this share goes on to the coarser ones. So the glow's
// outermost parts, which more levels would add, hold 0.7^(levels - 1) of its light.
SHARED_CONST float kBloomShare = 0.7f;

// Most of a channel that one pixel gives: the sun's disc would fill the picture.
SHARED_CONST float kMostTaken = 32.0f;

// Of a coarser level, that an invocation takes downwards where levels are made by columns.
SHARED_CONST uint kSpreadRows = 16u;

// One step between two levels. Level 0 is the radiance image; level n has half the edges of level
// n - 1, rounded up.
struct BloomStep {
  uvec2 fine_size;  // of the level with more pixels
  uvec2 coarse_size;
  float threshold;  // exposed brightness that is taken whole what it exceeds it by
  float intensity;  // of what was taken, what is added to the picture
};

SHARED_END
#endif
