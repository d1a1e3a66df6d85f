#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "world/islands/stored_voxels.h"
#include "world/islands/world.h"
#include "world/motion/solid_grid.h"
#include "world/voxel/motion_state.h"

namespace skerry::world {

/// Solid voxels that hang together but not with the rest of their island.
struct Fragment {
  std::map<IVec3, BitBrick> bricks;  ///< by brick coordinate
  Mass mass;                         ///< in the lattice of the island it was part of
};

struct SplitSearch {
  std::vector<Fragment> fragments;  ///< none: the island holds together
  std::size_t bricks_looked_at = 0;
};

/// Whether the island falls apart where voxels have just been taken away. The sides next to them
/// grow at the same pace, brick by brick, until they meet or all but one are done: what remains of
/// the island is never walked through. Work is bounded by the number of sides times the bricks of
/// the largest fragment; if the sides do meet, by the bricks within the way they meet on.
/// @param grid without those voxels.
SplitSearch find_fragments(const SolidGrid& grid, std::span<const IVec3> removed);

/// A fragment's voxels and what stands on them, copied from their island.
struct LoosePiece {
  std::shared_ptr<const StoredVoxels> voxels;  ///< in a lattice of their own
  glm::dvec3 shift{};                          ///< from the island's lattice to that, whole blocks
  IslandSpec spec;                             ///< box and radius
  Mass mass;                                   ///< in their own lattice
  std::map<IVec3, ChunkEdits> taken;           ///< air for each of them, on the island
};
/// @param fragment voxels of it that are no longer solid by now are left out. @return none: nothing
/// of it is left.
std::optional<LoosePiece> copy_piece(World& world, std::uint64_t island, const Fragment& fragment);

/// What a fragment became.
struct BrokenOff {
  std::uint64_t island = 0;
  Mass mass;                   ///< in its own lattice
  glm::dvec3 shift{};          ///< from the old lattice to its own
  std::vector<IVec3> changed;  ///< chunks of the old island that voxels were taken from
};

/// Moves a piece into an island of its own. Not a voxel moves in the world; the new lattice is the
/// old one shifted by whole blocks. The island stands still where it is until someone moves it
/// (IslandMotion::add).
/// @param piece as the island is now. @param at pose of the old island, which must be known.
BrokenOff break_off(World& world, std::uint64_t island, const LoosePiece& piece, const Pose& at);

}  // namespace skerry::world
