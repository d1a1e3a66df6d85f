#include "game/player/collide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "tests/game/player/test_world.h"

namespace skerry::game {
namespace {

using world::IVec3;

constexpr double kGap = 1.0 / 4096.0;

SolidQuery clutter(std::uint32_t seed, std::uint32_t percent) {
  return [=](IVec3 v) { return voxel_hash(v, seed) % 100 < percent; };
}

/// Volume that the box at `feet` shares with solids, straight from the definition.
bool overlaps(const SolidQuery& solid, const glm::dvec3& feet, double slack = 1e-9) {
  for (int x = static_cast<int>(feet.x) - 3; x <= feet.x + 3; ++x)
    for (int y = static_cast<int>(feet.y) - 3; y <= feet.y + 5; ++y)
      for (int z = static_cast<int>(feet.z) - 3; z <= feet.z + 3; ++z) {
        const auto share = [&](double low, double high, int at) {
          return std::min(high, at + 1.0) - std::max(low, double(at)) > slack;
        };
        if (share(feet.x - 0.3, feet.x + 0.3, x) && share(feet.y, feet.y + 1.8, y) &&
            share(feet.z - 0.3, feet.z + 0.3, z) && solid({x, y, z}))
          return true;
      }
  return false;
}

glm::dvec3 free_place(const SolidQuery& solid, std::mt19937& random) {
  std::uniform_real_distribution<double> place(-20.0, 20.0);
  for (;;) {
    const glm::dvec3 feet{place(random), place(random), place(random)};
    if (!overlaps(solid, feet, -kGap)) return feet;
  }
}

TEST(Collide, SharesOfAMotionAlongAnAxisEndAtTheFirstSolidOnIt) {
  // Truth: of all voxels in the box's way, the nearest; no stepping.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> length(-40.0, 40.0);
  int stopped = 0;
  for (int round = 0; round < 2000; ++round) {
    const SolidQuery solid = clutter(static_cast<std::uint32_t>(round), 3 + round % 20);
    const glm::dvec3 feet = lattice_blocks(lattice_pos(free_place(solid, random)));
    const int axis = round % 3;
    glm::dvec3 motion{0.0};
    motion[axis] = length(random);
    const glm::dvec3 low{feet.x - 0.3, feet.y, feet.z - 0.3};
    const glm::dvec3 high{feet.x + 0.3, feet.y + 1.8, feet.z + 0.3};
    double way = std::abs(motion[axis]);
    bool blocked = false;
    glm::ivec3 v;
    const auto from = [&](int a) {
      return static_cast<int>(std::floor(low[a])) - (a == axis) * 42;
    };
    const auto to = [&](int a) { return static_cast<int>(std::floor(high[a])) + (a == axis) * 42; };
    for (v.x = from(0); v.x <= to(0); ++v.x)
      for (v.y = from(1); v.y <= to(1); ++v.y)
        for (v.z = from(2); v.z <= to(2); ++v.z) {
          if (!solid({v.x, v.y, v.z})) continue;
          const double ahead =
              motion[axis] > 0.0 ? v[axis] - high[axis] : low[axis] - v[axis] - 1.0;
          if (ahead < 0.0 || ahead - kGap >= way) continue;
          way = ahead - kGap;
          blocked = true;
        }
    const SweepResult swept = sweep_box(solid, lattice_pos(feet), lattice_pos(motion));
    const glm::dvec3 end = lattice_blocks(swept.feet);
    EXPECT_EQ(swept.blocked[axis], blocked ? (motion[axis] > 0.0 ? 1 : -1) : 0);
    EXPECT_NEAR(end[axis] - feet[axis], motion[axis] > 0.0 ? way : -way, 1e-8);
    for (int other = 0; other < 3; ++other) EXPECT_TRUE(other == axis || end[other] == feet[other]);
    stopped += blocked;
  }
  EXPECT_GT(stopped, 500);
  EXPECT_LT(stopped, 1990);
}

TEST(Collide, AnyMotionEndsFreeOfSolidsAndStopsOnlyAtSolids) {
  std::mt19937 random(4);
  std::normal_distribution<double> motion_blocks(0.0, 6.0);
  for (int round = 0; round < 3000; ++round) {
    const SolidQuery solid = clutter(static_cast<std::uint32_t>(round / 10), 2 + round % 30);
    const LatticePos feet = lattice_pos(free_place(solid, random));
    const LatticePos motion =
        lattice_pos({motion_blocks(random), motion_blocks(random), motion_blocks(random)});
    for (const bool climbs : {false, true}) {
      const SweepResult swept =
          climbs ? climb_box(solid, feet, motion) : sweep_box(solid, feet, motion);
      ASSERT_FALSE(overlaps(solid, lattice_blocks(swept.feet)));
      for (int axis = 0; axis < 3; ++axis) {
        if (climbs && axis == 1) continue;  // a step ends on a ledge, wherever the motion went
        const std::int64_t went = swept.feet[axis] - feet[axis];
        if (swept.blocked[axis] == 0) {
          EXPECT_EQ(went, motion[axis]);
        } else {
          EXPECT_LE(std::abs(went), std::abs(motion[axis]) + kContactGap);
        }
      }
    }
  }
}

TEST(Collide, AStoppedBoxTouchesWhatStoppedIt) {
  std::mt19937 random(6);
  for (int round = 0; round < 500; ++round) {
    const SolidQuery solid = clutter(static_cast<std::uint32_t>(round), 10);
    const LatticePos feet = lattice_pos(free_place(solid, random));
    const SweepResult down = sweep_box(solid, feet, lattice_pos({0.0, -60.0, 0.0}));
    if (down.blocked.y == 0) continue;
    EXPECT_TRUE(is_supported(solid, down.feet));
    EXPECT_TRUE(overlaps(solid, lattice_blocks(down.feet) - glm::dvec3(0.0, 2.0 * kGap, 0.0)));
    // At rest, gravity does not move it by a single unit.
    EXPECT_EQ(sweep_box(solid, down.feet, lattice_pos({0.0, -0.01, 0.0})).feet, down.feet);
  }
}

TEST(Collide, AMotionInSharesIsExactlyTheMotion) {
  std::mt19937_64 random(8);
  for (int round = 0; round < 1000; ++round) {
    const auto any = [&] {
      return static_cast<std::int64_t>(random() % (600ull << 32)) - (300ll << 32);
    };
    const LatticePos feet{any(), any(), any()}, motion{any(), any(), any()};
    EXPECT_EQ(sweep_box([](IVec3) { return false; }, feet, motion).feet, feet + motion);
  }
}

}  // namespace
}  // namespace skerry::game
