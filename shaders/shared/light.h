// Lights of a frame besides sun and moon, as CPU and GPU share them. "World" is relative to the
// camera, in blocks: docs/conventions.md.
#ifndef SKERRY_SHARED_LIGHT_H
#define SKERRY_SHARED_LIGHT_H
#include "types.h"
SHARED_BEGIN

// Irradiance of a surface facing the light at distance d is intensity / d^2 times the window
// (1 - (d / range)^4)^2, which is 0 from `range` on. A directional light has neither.
SHARED_CONST uint kLightPoint = 0u;
SHARED_CONST uint kLightSpot = 1u;         // a cone about `axis`, both ways if dual
SHARED_CONST uint kLightTube = 2u;         // a line along `axis`, `size` to either side
SHARED_CONST uint kLightSphere = 3u;       // of radius `size`
SHARED_CONST uint kLightDirectional = 4u;  // `intensity` is the irradiance of a surface facing it
SHARED_CONST uint kLightKindCount = 5u;

SHARED_CONST uint kLightKindMask = 7u;  // of Light.kind
SHARED_CONST uint kLightDualBit = 8u;   // a spot that shines along -axis as well

// Among bits of kinds that a frame has: some light has panes.
SHARED_CONST uint kLightPanesBit = 1u << kLightKindCount;

SHARED_CONST uint kLightTexels = 5u;  // of 128 bits
SHARED_CONST uint kPaneTexels = 2u;   // of a LightPane; they come after all lights

struct Light {
  vec3 position;      // world; a directional light's is not used
  float range;        // blocks, > 0; a directional light is blocked by what lies within it
  vec3 intensity;     // linear RGB [unit of sun radiance * block^2], >= 0
  uint kind;          // kLight..., and bits
  vec3 axis;          // unit: where a spot looks, along a tube, where a directional light goes
  float size;         // blocks, >= 0: see the kinds; 0 for the others
  float cos_inner;    // spot: full light within
  float cos_outer;    // spot: none beyond; < cos_inner
  uint first_island;  // into the frame's list of islands that may block lights: those whose
  uint island_count;  // bounding spheres the light's range touches
  uint reach;  // 1 + which of the frame's LightReach bounds what it can arrive at; 0: its range
               // alone
  uint first_pane;  // of the frame's LightPane
  uint pane_count;  // that stand in its range; of a directional light none
  uint unused;
};

// A box of stained glass that light passes.
struct LightPane {
  vec3 low;  // lattice [blocks]
  uint block;
  vec3 high;
  uint island;  // of the frame's islands
};

SHARED_CONST uint kReachWords = 128u;

// Where past walls a light can arrive at surfaces of the one island that it touches, in bricks of
// its lattice. Bit z + size.z * (x + size.x * y): a face or a plant may be lit in the brick.
struct LightReach {
  ivec3 low;  // bricks
  ivec3 size;
  float per_block;  // bricks in a block
  uint edge_log2;   // of a brick [voxels of the island's level]
  uint island;
  uint bits[kReachWords];
};

SHARED_END
#endif
