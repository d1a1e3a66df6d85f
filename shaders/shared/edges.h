// Edges of surfaces in the picture, smoothed by the share of a pixel that each side covers.
// docs/decisions/0043.
#ifndef SKERRY_SHARED_EDGES_H
#define SKERRY_SHARED_EDGES_H
#include "types.h"
SHARED_BEGIN

SHARED_CONST uint kEdgeParts = 2u;  // of a tile, four columns each: what an invocation looks at

// Of tiles, as many as a group of that many parts takes; of pixels, 64 a group; of tiles, one a
// group.
SHARED_CONST uint kEdgeDispatches = 3u;

// How far reverse depth may bend on a plane, of what it bends where two faces of a block meet that
// are seen alike. Rounding bends it a hundred times less.
SHARED_CONST float kBendOfPlane = 0.05f;

// A pixel at an edge. Its picture is read before any is written.
struct EdgePixel {
  uint place;   // x in bits 0-15, y in bits 16-31
  uint colour;  // what it becomes, RGBA8
};

SHARED_END
#endif
