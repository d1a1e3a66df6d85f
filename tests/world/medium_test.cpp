#include "world/islands/medium.h"

#include <gtest/gtest.h>

#include "world/voxel/blocks.h"

namespace skerry::world {
namespace {

/// A column of water from y 640 to 643, far above the home island of seed 1.
struct Column {
  World world{{.seed = 1, .island_limit = 1}};
  const std::uint64_t home = world.islands_near(world.origin(), 1000.0, 0.0).front().id;
  Column() {
    world.ensure_chunk(home, chunk_of({5, 640, 5}));
    for (int y = 640; y < 644; ++y) put(y, block::kWater);
  }
  void put(int y, BlockId id) { world.set_block(home, {5, y, 5}, id); }
  Medium at(double y) const { return medium_at(world, home, {5.5, y, 5.5}); }
};

TEST(Medium, EndsWhereTheLastBlockOfItsKindIs) {
  const Column column;
  for (const double y : {640.0, 641.5, 643.99}) {
    EXPECT_EQ(column.at(y).block, block::kWater) << y;
    EXPECT_EQ(column.at(y).below_surface, (IVec3{5, 643, 5})) << y;
  }
  for (const double y : {639.99, 644.0}) EXPECT_EQ(column.at(y).block, kAir) << y;
}

TEST(Medium, HasNoSurfaceBelowRockAndOneBelowGlass) {
  Column column;
  column.put(644, block::kGlass);
  EXPECT_EQ(column.at(641.0).below_surface, (IVec3{5, 643, 5}));
  EXPECT_EQ(column.at(644.5).block, block::kGlass);
  column.put(644, block::kStone);
  EXPECT_EQ(column.at(641.0).block, block::kWater);
  EXPECT_EQ(column.at(641.0).below_surface, std::nullopt);
}

TEST(Medium, GetsLessLightFromDeepSurfacesWithoutAStep) {
  Column column;
  for (int y = 644; y < 760; ++y) {
    column.world.ensure_chunk(column.home, chunk_of({5, y, 5}));
    column.put(y, block::kWater);
  }
  float before = 0.0f;
  for (double y = 640.0; y < 760.0; y += 0.0625) {
    const Medium medium = column.at(y);
    const float light = medium.below_surface ? medium.light : 0.0f;
    EXPECT_GE(light, before) << y;
    EXPECT_LE(light, before + 0.004f) << y;  // a step of light that no picture shows
    before = light;
    if (y > 729.0) {
      EXPECT_EQ(light, 1.0f) << y;
    }
    if (y < 695.0) {
      EXPECT_EQ(light, 0.0f) << y;
    }
  }
}

TEST(Medium, IsAirWhereNothingIsKnown) {
  const Column column;
  EXPECT_EQ(medium_at(column.world, column.home, {5.5, 1e6, 5.5}).block, kAir);
  EXPECT_EQ(medium_at(column.world, column.home + 1, {5.5, 641.0, 5.5}).block, kAir);
}

}  // namespace
}  // namespace skerry::world
