#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "world/motion_state.h"
#include "world/solid_grid.h"
#include "world/world.h"

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

/// What a fragment became.
struct BrokenOff {
  std::uint64_t island = 0;
  Mass mass;  ///< in its own lattice
};

/// Moves a fragment's voxels, and what stands on them, into an island of their own. Not a voxel
/// moves in the world; the new lattice is the old one shifted by whole blocks. The island stands
/// still where it is until someone moves it (IslandMotion::add).
/// @param at pose of the old island, which must be known.
BrokenOff break_off(World& world, std::uint64_t island, const Fragment& fragment, const Pose& at);

}  // namespace skerry::world
