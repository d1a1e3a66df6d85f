#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "world/generate/biome.h"
#include "world/generate/shape.h"

namespace skerry::world {

/// Heights of an island, one entry a column of voxels, and what covers them. Square, centred on the
/// lattice origin.
struct Columns {
  static constexpr std::int16_t kNoGround = -30000;  ///< `top` of a column without rock
  static constexpr std::int16_t kNoRock = 30000;     ///< `bottom` of a column without rock
  static constexpr std::int16_t kDry = -30000;       ///< `water` of a column without liquid
  static constexpr std::int16_t kOpenRoof = 30000;

  int half = 0;  ///< columns cover [-half, half) in x and z
  int edge = 0;
  std::vector<std::int16_t> top;  ///< rock fills bottom <= y < top
  std::vector<std::int16_t> bottom;
  std::vector<std::int16_t> water;  ///< liquid fills top <= y < water
  std::vector<std::int16_t>
      roof;  ///< caves stay below this, so that they reach no lake and no meadow
  std::vector<std::int16_t> inside;  ///< distance to the outline, blocks, positive inside
  std::vector<std::uint8_t>
      ragged;  ///< how far noise may shift the rock sideways here: 0 none .. 255 all of `max_shift`
  std::vector<SkinId> skins;
  int max_shift = 0;  ///< in 1/256 block

  /// Heights among all columns from which a ragged one may take its rock: none outside bottom..top,
  /// all rock and no turf inside core_bottom..core_top.
  struct Reach {
    std::int16_t bottom, top, core_bottom, core_top;
  };
  static constexpr int kReachCell = 4;
  std::vector<Reach> reaches;  ///< one for kReachCell^2 columns
  int highest = kNoGround, lowest = kNoRock;

  bool has(int x, int z) const { return x >= -half && x < half && z >= -half && z < half; }
  std::size_t index(int x, int z) const {
    return static_cast<std::size_t>(x + half) * static_cast<std::size_t>(edge) +
           static_cast<std::size_t>(z + half);
  }
  const Reach& reach_at(int x, int z) const {
    return reaches[static_cast<std::size_t>((x + half) / kReachCell) *
                       static_cast<std::size_t>(edge / kReachCell) +
                   static_cast<std::size_t>((z + half) / kReachCell)];
  }
  /// The column that a ragged one takes its rock from. @param share_x, share_z Q12 share of the
  /// shift allowed there.
  std::size_t shifted_index(int x, int z, std::size_t i, int share_x, int share_z) const {
    const int reach = ragged[i] * max_shift >> 8;  // Q8 blocks
    const int sx = std::clamp(x + ((share_x * reach + (1 << 19)) >> 20), -half, half - 1);
    const int sz = std::clamp(z + ((share_z * reach + (1 << 19)) >> 20), -half, half - 1);
    return index(sx, sz);
  }
};

/// Height maps from a design. Fills in the lake levels and arch feet that the design left to the
/// ground.
Columns build_columns(Shape& shape);

}  // namespace skerry::world
