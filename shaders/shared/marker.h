// The block that a player points at: its outline and how far it is dug, drawn over the picture.
#ifndef SKERRY_SHARED_MARKER_H
#define SKERRY_SHARED_MARKER_H
#include "types.h"
SHARED_BEGIN

// Lengths in blocks; axes are those of the lattice the box stands in, from the box's lowest corner.
struct MarkerConstants {
  vec3 eye;
  vec3 right;        // as FrameConstants.ray_right, turned into the lattice
  vec3 up;           // as FrameConstants.ray_up
  vec3 forward;      // as FrameConstants.ray_forward
  vec3 size;         // of the box
  uvec2 first;       // lowest pixel that it can touch
  uvec2 end;         // past the highest one
  float half_width;  // of the lines [pixels]
  float dug;         // 0: no cracks .. 1: all of the block is cracked
};

SHARED_END
#endif
