// Pictures mixed with those of earlier frames. docs/decisions/0048.
#ifndef SKERRY_SHARED_TEMPORAL_H
#define SKERRY_SHARED_TEMPORAL_H
#include "types.h"
SHARED_BEGIN

SHARED_CONST uint kMotionTexels = 3u;  // of 128 bits, one a row

// Where the last frame saw what moves with an island, or with the sky: with a place in the picture
// [pixels] and its reverse depth, p = dot(row, (x, y, 1, depth)); in the last frame it was at
// (p.x, p.y) / p.w, of reverse depth depth / p.w.
struct Motion {
  vec4 x;
  vec4 y;
  vec4 w;  // all 0: it was not there
};

struct TemporalStep {
  uvec4 changed_area;    // from xy to before zw: sections came or went there since the last frame
  vec2 last_sample;      // FrameConstants.sample_in_pixel of the last frame
  float exposure_ratio;  // of dark light of the display under this exposure and the last one
  float bend;            // of reverse depth, as a share of it: less is a plane
  uint sky;              // index of the sky's Motion; the islands' come before
  uint kept;             // 1: there is a last frame
};

SHARED_END
#endif
