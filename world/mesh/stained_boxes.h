#pragma once
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "world/mesh/occupancy.h"

namespace skerry::world {

/// A box of stained glass of one kind.
struct StainedBox {
  glm::ivec3 low{}, size{};  ///< voxels, from the chunk's lowest corner
  BlockId block = kAir;
  bool operator==(const StainedBox&) const = default;
};

/// Boxes that cover a chunk's stained glass, each voxel once: grown along z, then x, then y.
/// @param voxels as stained_voxels_of() gives them.
std::vector<StainedBox> stained_boxes_of(std::span<const StainedVoxel> voxels);

}  // namespace skerry::world
