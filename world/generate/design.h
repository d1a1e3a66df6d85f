// What an island's design says of one place: the functions of a Shape that columns are made of, and
// samples for what is too far away for columns. Lengths are Q8 blocks where the name says so.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "world/generate/noise.h"
#include "world/generate/shape.h"
#include "world/voxel/hash.h"

namespace skerry::world {

/// How noise moves a design's parts at a place, Q8.
struct Bend {
  int x, z;
};
/// @param x8, z8 Q8, of this and the next ones.
Bend bend_at(const Shape& shape, int x8, int z8);
/// Distance into the outline, Q8, negative outside.
int inside_at(const Shape& shape, int x8, int z8, Bend bend);
/// Hills, crags and peaks above the rim, Q8. @param inside8 inside_at().
int elevation_at(const Shape& shape, int x8, int z8, int inside8);
/// How deep the rock hangs under the base plane: a tapering keel with folds, Q8.
int thickness_at(const Shape& shape, int x8, int z8, int inside8);
/// Chooses between the skins of a biome.
int patch_at(const Shape& shape, int x8, int z8);

/// The rise of a butte.
class ButteRise {
 public:
  explicit ButteRise(const Butte& butte);
  /// Q8, at a column.
  int at(int x, int z, Bend bend) const;

 private:
  const Butte* butte_;
  int ramp_x_, ramp_z_;
  std::int64_t foot_, table_;  // squares, Q8; nearer than the table all is up
};

/// A hanging cone of rock.
struct Spike {
  int x, z, reach;
  int share;  ///< of 128, of the rock above
  int length_at(int bottom) const { return (6 - bottom) * share / 128 + reach / 2; }
  /// Blocks that it reaches below the bottom of a column. @param length length_at() its middle.
  int depth_at(int column_x, int column_z, int length) const;
};
/// A jittered grid of spikes.
struct SpikeGrid {
  int spacing, of_256;  ///< share of the cells that have one
  std::uint32_t seed;
};
/// The large ones first.
std::array<SpikeGrid, 2> spike_grids(const Shape& shape);
/// Calls f(spike) for those whose middle may lie within `half` of the origin.
template <class F>
void for_spikes(const SpikeGrid& grid, int half, F&& f) {
  const int cells = half / grid.spacing + 1;
  for (int cx = -cells; cx <= cells; ++cx) {
    for (int cz = -cells; cz <= cells; ++cz) {
      Rng rng(hash2(grid.seed, cx, cz));
      if (!rng.chance(grid.of_256)) continue;
      Spike spike{};
      spike.x = cx * grid.spacing + rng.in(0, grid.spacing - 1);
      spike.z = cz * grid.spacing + rng.in(0, grid.spacing - 1);
      spike.reach = rng.in(grid.spacing / 3, grid.spacing * 4 / 5);
      spike.share = rng.in(14, 90);
      f(spike);
    }
  }
}

inline constexpr int kShoreSteps = 32;  ///< places that a shore is looked at, each way around
/// Finds a radius at which the whole shore lies inland, and a level. False when there is no such
/// place. @param steps places each way around; @pre a divisor of 1024. @param ground_at(x, z) an
/// optional: ground of a column [Q8]; none: not inland.
template <class GroundAt>
bool settle(Lake& lake, int steps, const GroundAt& ground_at) {
  constexpr int kShoreRoom = 7;
  for (; lake.radius >= 4; lake.radius = lake.radius * 5 / 6) {
    int lowest = std::numeric_limits<int>::max();
    bool inland = true;
    for (int a = 0; a < 1024 && inland; a += 1024 / steps) {
      for (const int distance : {lake.radius + 2, lake.radius + kShoreRoom}) {
        if (!inland) break;
        const std::optional<int> ground =
            ground_at(lake.x + distance * noise::cosine(a) / noise::kOne12,
                      lake.z + distance * noise::sine(a) / noise::kOne12);
        inland = ground.has_value();
        if (inland) lowest = std::min(lowest, *ground);
      }
    }
    if (!inland) continue;
    if (lake.level == kLevelFromGround) lake.level = lowest / noise::kOne8;
    return lake.level > 0;
  }
  return false;
}

inline constexpr int kLakeReach = 12;  ///< blocks around the water until the old ground is reached
struct LakeColumn {
  int ground;  ///< Q8
  bool wet, shore;
  bool dug = false;  ///< water fills it to the lake's level
};
/// Digs a settled lake at a column.
void dig_at(const Lake& lake, int x, int z, Bend bend, LakeColumn& column);

struct Ground {
  int height;  ///< Q8
  int bottom;  ///< blocks
};
/// Rock fills bottom <= y < top.
struct Heights {
  int top, bottom;
};
/// A column's heights, kept within the island's box and sphere.
Heights heights_at(const Shape& shape, int x, int z, const Ground& ground);

/// What chooses a column's skin.
struct SkinPlace {
  int x, z;
  Bend bend;
  int patch, height, inside;  ///< inside [blocks]
  bool wet, steep, shore;
};
SkinId skin_at(const Shape& shape, const SkinPlace& place);

}  // namespace skerry::world
