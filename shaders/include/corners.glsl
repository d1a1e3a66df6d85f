// Corners take a part of all light. Needs before the include: `frame`, `islands[]`, surface.glsl.
#ifndef SKERRY_CORNERS_GLSL
#define SKERRY_CORNERS_GLSL
#include "shared/constants.h"
#include "include/occupancy.glsl"

// Whether they do. If not, some buffers are bound for the occupancy that are never read.
layout(constant_id = kCornersConstant) const bool kCorners = false;

// Share of light that corners leave to a surface. Plants are loose leaves, which have none.
float surface_openness(Surface s, uint word) {
  if (!kCorners) return 1.0;
  uint island = surface_island(word), face = min(surface_face(word), 5u);
  float openness = corner_openness(island, face, lattice_from_world(islands[island], s.position));
  return s.plant ? 1.0 : 1.0 - frame.corner_darkening * (1.0 - openness);
}
#endif
