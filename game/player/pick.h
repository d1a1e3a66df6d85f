// Which block a view's middle points at.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

#include "game/player/player.h"
#include "world/voxel/blocks.h"
#include "world/voxel/coords.h"

namespace skerry::game {

/// A block pointed at.
struct Pick {
  std::uint64_t island = 0;
  world::IVec3 voxel;  ///< of the island's lattice
  world::BlockId block = world::kAir;
  int face = 2;           ///< that the ray enters by: 0 .. 5, docs/conventions.md
  double distance = 0.0;  ///< blocks from the eye to there
  bool operator==(const Pick&) const = default;
};

/// A box in a voxel [blocks from its lowest corner].
struct VoxelBox {
  glm::dvec3 min{0.0}, max{1.0};
};
/// What of a block's voxel is pointed at and outlined: all of it, but of a torch and of other
/// plants, which fill little of theirs, an upright box about their shape.
VoxelBox pick_box(world::BlockId block);

/// The nearest block along a ray over all islands; air and water let it pass. A ray that begins in
/// a block picks what it comes to after leaving it. Nothing is picked behind voxels that are not
/// loaded yet. @param direction in the world, of unit length. @param reach blocks.
std::optional<Pick> pick_block(const Surroundings& around, world::WorldPos eye,
                               const glm::dvec3& direction, double reach, double time_s);

/// Where a yaw and a pitch look (docs/conventions.md).
glm::dvec3 view_direction(double yaw_deg, double pitch_deg);

/// The voxel beyond a face.
world::IVec3 beyond_face(world::IVec3 voxel, int face);

}  // namespace skerry::game
