// Corners take a part of all light. Needs before the include: `frame`, `island_at()`, surface.glsl.
#ifndef SKERRY_CORNERS_GLSL
#define SKERRY_CORNERS_GLSL
#include "shared/constants.h"
#include "include/scene/occupancy.glsl"

// Whether they do. If not, some buffers are bound for the occupancy that are never read.
layout(constant_id = kAoConstant) const bool kAo = false;

// Share of light that corners leave to a surface. Plants are loose leaves, which have none.
float surface_ao(Surface s, uint word) {
  if (!kAo) return 1.0;
  uint island = surface_island(word), face = min(surface_face(word), 5u);
  float ao = corner_ao(island, face, lattice_from_world(island_at(island), s.position));
  return s.plant ? 1.0 : 1.0 - frame.ao_strength * (1.0 - ao);
}
#endif
