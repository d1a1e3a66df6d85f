// Moving a box through voxels.
#pragma once
#include <functional>
#include <glm/vec3.hpp>

#include "world/coords.h"

namespace skerry::game {

/// A player's box, axis-aligned in the lattice it meets; its place is the middle of its bottom face
/// [blocks].
inline constexpr double kPlayerHalfWidth = 0.3;
inline constexpr double kPlayerHeight = 1.8;
/// The gap a stopped box keeps to what stopped it. Rounding a place to 1/65536 block moves it by
/// less, so it never rounds into a solid.
inline constexpr double kContactGap = 1.0 / 4096.0;

/// Whether a voxel stops the player.
using SolidQuery = std::function<bool(world::IVec3 voxel)>;

/// Whether the open box at `feet` shares volume with a solid voxel.
bool box_overlaps(const SolidQuery& solid, const glm::dvec3& feet);

struct SweepResult {
  glm::dvec3 feet{};      ///< where the box ends
  glm::ivec3 blocked{0};  ///< per axis: the sign of the motion that a solid stopped, else 0
};

/// Moves a box by `motion`, stopping each axis (y, then x, then z) at the first solid, in steps
/// short enough that the order of the axes does not matter to a player. No length of motion passes
/// through a solid.
/// @pre |feet| + |motion| < 2^30. A box that starts inside solids is only stopped by solids it does
/// not touch yet.
SweepResult sweep_box(const SolidQuery& solid, const glm::dvec3& feet, const glm::dvec3& motion);

/// A free place for a box that overlaps solids: the nearest along the six axes within two blocks,
/// else the first upwards within `max_rise` blocks. @return false when there is none; `feet` is
/// then unchanged.
bool push_out(const SolidQuery& solid, glm::dvec3& feet, int max_rise);

}  // namespace skerry::game
