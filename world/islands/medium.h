#pragma once
#include <glm/vec3.hpp>
#include <optional>

#include "world/islands/world.h"

namespace skerry::world {

/// What an eye looks through.
struct Medium {
  BlockId block = kAir;                ///< translucent, or air
  std::optional<IVec3> below_surface;  ///< its last voxel upwards, if light enters through the top
  float light = 0.0f;  ///< share of that light that is taken to get here: all of it 32 blocks deep,
                       ///< then less, none from 64 blocks on
};

/// The translucent block at a place of an island's lattice. Its surface is looked for 64 blocks
/// up; there is none below an opaque block. Air where the chunk is not loaded.
Medium medium_at(const World& world, std::uint64_t island, const glm::dvec3& place);

}  // namespace skerry::world
