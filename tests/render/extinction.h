#pragma once
#include <glm/vec3.hpp>

#include "world/voxel/blocks.h"

namespace skerry::render {

/// What a translucent block takes of light, RGB [1/block of path].
inline glm::dvec3 extinction_of(world::BlockId block) {
  const world::BlockType& type = world::block_types()[block];
  return glm::dvec3(type.absorption[0], type.absorption[1], type.absorption[2]) +
         static_cast<double>(type.scattering);
}

}  // namespace skerry::render
