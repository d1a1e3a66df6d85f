// Pictures mixed with those of earlier frames. docs/decisions/0088.
#ifndef SKERRY_SHARED_TEMPORAL_H
#define SKERRY_SHARED_TEMPORAL_H
#include "types.h"
SHARED_BEGIN

SHARED_CONST uint kMotionTexels = 3u;  // of 128 bits, one a row

// Frames that are mixed, this one among them. Each has a slot, a layer of the images that keep
// them.
SHARED_CONST uint kMixedFrames = 8u;

// Where the frames of a slot sample a pixel at rest, from its centre: in eighths of a pixel, -4
// to 3. The first points of Sobol's sequence, of which the second half and each quarter lie apart,
// too.
SHARED_FUNCTION int centred_eighths(uint at) {
  return at < 4u ? int(at) : int(at) - 8;
}
SHARED_FUNCTION int jitter_x(uint slot) {
  return centred_eighths(((slot & 1u) << 2u) | (slot & 2u) | (slot >> 2u));
}
SHARED_FUNCTION int jitter_y(uint slot) {
  return centred_eighths(((slot & 1u) * 4u) ^ ((slot >> 1u & 1u) * 6u) ^ ((slot >> 2u) * 5u));
}

// Where an earlier frame saw what moves with an island, or with the sky: with a place in the
// picture [pixels] and its reverse depth, p = dot(row, (x, y, 1, depth)); in that frame it was at
// (p.x, p.y) / p.w, of reverse depth depth / p.w. A table has one for each island, then the sky's,
// for each slot in turn.
struct Motion {
  vec4 x;
  vec4 y;
  vec4 w;  // all 0: it was not there
};

struct TemporalStep {
  uvec4 changed_area;  // from xy to before zw: sections came or went there since the oldest frame
  float exposure_ratios[kMixedFrames];  // of dark light of the display under this exposure and a
                                        // slot's
  uint sky;                             // index of the sky's Motion; the islands' come before
  uint kept;                            // bit a slot: it has an earlier frame
  uint slot;                            // of this frame
  uint still;  // bit a slot: neither the view nor an island in it has moved since
};

SHARED_END
#endif
