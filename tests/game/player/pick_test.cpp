#include "game/player/pick.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/game/player/test_world.h"

namespace skerry::game {
namespace {

using world::BlockId;
using world::IVec3;

BlockId random_block(IVec3 v, std::uint32_t seed) {
  constexpr BlockId kBlocks[] = {world::block::kStone, world::block::kGlass,
                                 world::block::kTorch, world::block::kTallGrass,
                                 world::block::kWater, world::block::kOakLeaves};
  const std::uint32_t h = voxel_hash(v, seed);
  return h % 16 < 6 ? kBlocks[h % 16] : world::kAir;
}

/// The truth: every block's box within reach against the ray, in no order.
std::optional<Pick> nearest_box(const TestWorld& world, world::WorldPos eye,
                                const glm::dvec3& direction, double reach, double time_s) {
  std::optional<Pick> nearest;
  for (std::uint64_t island = 0; island < world.islands.size(); ++island) {
    const world::Pose pose = *world.pose(island, time_s);
    const glm::dvec3 origin = lattice_of(pose, eye);
    const glm::dvec3 local = glm::conjugate(pose.rotation) * direction;
    const glm::ivec3 middle(glm::floor(origin));
    const int span = static_cast<int>(reach) + 2;
    for (int x = middle.x - span; x <= middle.x + span; ++x)
      for (int y = middle.y - span; y <= middle.y + span; ++y)
        for (int z = middle.z - span; z <= middle.z + span; ++z) {
          const BlockId block = *world.block(island, {x, y, z});
          if (block == world::kAir || block == world::block::kWater) continue;
          const VoxelBox box = pick_box(block);
          double enter = -1e30, leave = 1e30;
          int face = -1;
          for (int axis = 0; axis < 3; ++axis) {
            const double corner = axis == 0 ? x : axis == 1 ? y : z;
            double a = (corner + box.min[axis] - origin[axis]) / local[axis];
            double b = (corner + box.max[axis] - origin[axis]) / local[axis];
            const bool reversed = a > b;
            if (reversed) std::swap(a, b);
            if (a > enter) enter = a, face = axis * 2 + (reversed ? 0 : 1);
            leave = std::min(leave, b);
          }
          if (enter < 0.0 || enter > leave || enter > reach) continue;
          if (nearest && enter >= nearest->distance) continue;
          nearest = Pick{island, {x, y, z}, block, face, enter};
        }
  }
  return nearest;
}

TEST(Pick, IsTheNearestBoxOverAllIslands) {
  std::mt19937 random(17);
  std::normal_distribution<double> normal;
  int picked = 0, nothing = 0, second_island = 0;
  for (int round = 0; round < 1500; ++round) {
    TestWorld world;
    const auto seed = static_cast<std::uint32_t>(round);
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 place{normal(random) * 3.0, normal(random) * 3.0, normal(random) * 3.0};
      const double heading = normal(random) * 3.0;
      world.islands.push_back({[=](double t) {
                                 return turning(at_blocks(1e6 + place.x, place.y, place.z), heading,
                                                t);
                               },
                               [=](IVec3 v) {
                                 return voxel_hash(v, seed + 99) % 5 == 0
                                            ? random_block(v, seed + static_cast<std::uint32_t>(i))
                                            : world::kAir;
                               }});
    }
    // An eye inside a block sees from there; brute force would not know.
    const world::WorldPos eye = at_blocks(1e6, 0.0, 0.0);
    bool inside = false;
    for (std::uint64_t i = 0; i < 3; ++i) {
      const glm::ivec3 v(glm::floor(lattice_of(*world.pose(i, 1.0), eye)));
      inside = inside || *world.block(i, {v.x, v.y, v.z}) != world::kAir;
    }
    if (inside) continue;
    const glm::dvec3 direction =
        glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    const double reach = 1.0 + round % 9;
    const auto expected = nearest_box(world, eye, direction, reach, 1.0);
    const auto found = pick_block(world, eye, direction, reach, 1.0);
    ASSERT_EQ(found.has_value(), expected.has_value()) << round;
    ++(found ? picked : nothing);
    if (!found) continue;
    EXPECT_EQ(found->island, expected->island);
    EXPECT_EQ(found->voxel, expected->voxel);
    EXPECT_EQ(found->block, expected->block);
    EXPECT_EQ(found->face, expected->face);
    EXPECT_NEAR(found->distance, expected->distance, 1e-9);
    second_island += found->island != 0;
  }
  EXPECT_GT(picked, 300);
  EXPECT_GT(nothing, 100);
  EXPECT_GT(second_island, 100);
}

TEST(Pick, NothingIsPickedBehindWhatIsNotLoaded) {
  TestWorld world;
  world.islands.push_back({[](double) { return still({}); },
                           [](IVec3 v) -> std::optional<BlockId> {
                             if (v.z == 2) return std::nullopt;
                             return v.z == 3 ? world::block::kStone : world::block::kAirBlock;
                           }});
  EXPECT_FALSE(pick_block(world, at_blocks(0.5, 0.5, 0.5), {0.0, 0.0, 1.0}, 6.0, 0.0));
  world.islands[0].edits[{0, 0, 2}] = world::kAir;
  const auto found = pick_block(world, at_blocks(0.5, 0.5, 0.5), {0.0, 0.0, 1.0}, 6.0, 0.0);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->voxel, (IVec3{0, 0, 3}));
  EXPECT_EQ(found->face, 5);
  EXPECT_DOUBLE_EQ(found->distance, 2.5);
}

TEST(Pick, AWallAtTheEndOfReachIsPickedAndBeyondItIsNot) {
  TestWorld world;
  world.islands.push_back(
      {[](double) { return still({}); },
       [](IVec3 v) { return v.x == 5 ? world::block::kStone : world::block::kAirBlock; }});
  EXPECT_TRUE(pick_block(world, at_blocks(0.0, 0.5, 0.5), {1.0, 0.0, 0.0}, 5.001, 0.0));
  EXPECT_FALSE(pick_block(world, at_blocks(0.0, 0.5, 0.5), {1.0, 0.0, 0.0}, 4.999, 0.0));
}

TEST(Pick, LooksAlongTheConventionsOfYawAndPitch) {
  EXPECT_LT(glm::distance(view_direction(0.0, 0.0), {0.0, 0.0, 1.0}), 1e-12);
  EXPECT_LT(glm::distance(view_direction(90.0, 0.0), {1.0, 0.0, 0.0}), 1e-12);
  EXPECT_LT(glm::distance(view_direction(30.0, -90.0), {0.0, -1.0, 0.0}), 1e-12);
}

}  // namespace
}  // namespace skerry::game
