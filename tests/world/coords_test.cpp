#include "world/voxel/coords.h"

#include <gtest/gtest.h>

namespace skerry::world {
namespace {

TEST(Coords, FloorDivisionRoundsTowardsMinusInfinity) {
  for (std::int64_t b : {1, 3, 64}) {
    for (std::int64_t a = -200; a <= 200; ++a) {
      const std::int64_t q = floor_div(a, b);
      const std::int64_t r = floor_mod(a, b);
      EXPECT_EQ(q * b + r, a);
      EXPECT_GE(r, 0);
      EXPECT_LT(r, b);
    }
  }
  EXPECT_EQ(floor_div(-1, 64), -1);
}

TEST(Coords, DifferencesAreExactFarFromTheOrigin) {
  const std::int64_t far = kMaxBlock * kUnitsPerBlock;
  const WorldPos here{far, -far, far};
  const WorldPos there = here + WorldPos{3, -kUnitsPerBlock, kUnitsPerBlock / 2};
  const glm::dvec3 d = difference_blocks(there, here);
  EXPECT_EQ(d.x, 3.0 / 65536.0);
  EXPECT_EQ(d.y, -1.0);
  EXPECT_EQ(d.z, 0.5);
}

TEST(Coords, MovingRoundsToTheNearestUnit) {
  const WorldPos from{10, 20, 30};
  const double unit = 1.0 / 65536.0;
  EXPECT_EQ(moved(from, {0.4 * unit, 0.6 * unit, -0.6 * unit}), (WorldPos{10, 21, 29}));
  EXPECT_EQ(moved(from, {1.0, -2.5, 0.0}), (WorldPos{10 + 65536, 20 - 163840, 30}));
}

}  // namespace
}  // namespace skerry::world
