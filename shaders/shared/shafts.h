// What is known of the ways from an 8x8-pixel tile to the lights of its lists: cull_shafts.comp
// (docs/decisions/0058).
#ifndef SKERRY_SHARED_SHAFTS_H
#define SKERRY_SHARED_SHAFTS_H
#include "types.h"
SHARED_BEGIN

SHARED_CONST uint kShaftLists = 2u;  // of a tile: clusters, that is slices of depth
SHARED_CONST uint kShaftWords = 4u;  // of 32 lights; those of a list beyond are not in it
SHARED_CONST uint kNoSlice = 255u;   // no list: nothing is known

// Bit i of a list stands for the light at place i of the cluster's list.
struct TileShafts {
  uint slices;                            // 8 bits a list, or kNoSlice
  uint asked[kShaftLists * kShaftWords];  // the light may light some pixel of the list
  uint open[kShaftLists * kShaftWords];   // nothing stands between it and any pixel that it lights
};

SHARED_END
#endif
