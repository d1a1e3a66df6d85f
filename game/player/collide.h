// Moving a box through voxels, in fixed point.
#pragma once
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>

#include "world/voxel/coords.h"

namespace skerry::game {

/// A place in an island's lattice: units of 2^-32 block. Sums and comparisons are exact, so that a
/// box at rest stays at the very same number, and no contact depends on rounding.
using LatticePos = glm::vec<3, std::int64_t>;
inline constexpr std::int64_t kLatticeBlock = std::int64_t{1} << 32;  ///< units in a block

/// Rounded to the nearest unit. @pre finite, within +-2^30 blocks.
LatticePos lattice_pos(const glm::dvec3& blocks);
glm::dvec3 lattice_blocks(const LatticePos& pos);

/// A player's box, axis-aligned in the lattice it meets; its place is the middle of its bottom face
/// [blocks].
inline constexpr double kPlayerHalfWidth = 0.3;
inline constexpr double kPlayerHeight = 1.8;
/// The gap a stopped box keeps to what stopped it [lattice units]: 1/4096 block. Rounding a place
/// to 1/65536 block moves it by less, so it never rounds into a solid.
inline constexpr std::int64_t kContactGap = kLatticeBlock / 4096;

/// Whether a voxel stops the player.
using SolidQuery = std::function<bool(world::IVec3 voxel)>;

/// Whether the open box at `feet` shares volume with a solid voxel.
bool box_overlaps(const SolidQuery& solid, const LatticePos& feet);
/// Whether a box at rest at `feet` stands on something.
bool is_supported(const SolidQuery& solid, const LatticePos& feet);

struct SweepResult {
  LatticePos feet{0};     ///< where the box ends
  glm::ivec3 blocked{0};  ///< per axis: the sign of the motion that a solid stopped, else 0
};

/// Moves a box by `motion`, stopping each axis (y, then x, then z) at the first solid, in steps
/// short enough that the order of the axes does not matter to a player. No length of motion passes
/// through a solid.
/// @pre |feet| + |motion| < 2^30 blocks. A box that starts inside solids is only stopped by solids
/// it does not touch yet.
SweepResult sweep_box(const SolidQuery& solid, const LatticePos& feet, const LatticePos& motion);

/// The same for someone who climbs: what stops them sideways and is no higher than a block above
/// their feet is stepped onto. @return as sweep_box; after a step, blocked.y is -1.
SweepResult climb_box(const SolidQuery& solid, const LatticePos& feet, const LatticePos& motion);

/// How much of a motion sideways keeps a box on what it stands on, axis by axis. Its y is kept.
LatticePos keep_on_edge(const SolidQuery& solid, const LatticePos& feet, LatticePos motion);

/// A free place for a box that overlaps solids: the nearest along the six axes within two blocks,
/// else the first upwards within `max_rise` blocks. @return false when there is none; `feet` is
/// then unchanged.
bool push_out(const SolidQuery& solid, LatticePos& feet, int max_rise);

}  // namespace skerry::game
