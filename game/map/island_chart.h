// An island seen from above.
#pragma once
#include <cstdint>
#include <vector>

#include "world/voxel/island.h"

namespace skerry::game {

/// Heights and colours of an island's surface, one cell for kStep x kStep columns, in its lattice.
struct IslandChart {
  static constexpr int kStep = 2;                  ///< blocks
  static constexpr std::int16_t kNoLand = -30000;  ///< height of a cell without ground
  struct Cell {
    std::int16_t height = kNoLand;  ///< of the surface, water included [blocks]
    std::uint8_t red = 0, green = 0, blue = 0;
  };
  int low_x = 0, low_z = 0;      ///< of the first cell [blocks]
  int cells_x = 0, cells_z = 0;  ///< cells each way
  std::vector<Cell> cells;       ///< row by row along z

  /// The cell at a place of the lattice [blocks]; null where there is no land.
  const Cell* at(double x, double z) const;
};

/// An island that a seed made, from the columns of its plan: without arches, caves and plants, and
/// without what players changed. Takes some milliseconds; any thread.
IslandChart chart_of(const world::IslandSpec& spec);
/// An island that no seed made has no plan: the outline of its box.
IslandChart outline_of(const world::IslandSpec& spec);

}  // namespace skerry::game
