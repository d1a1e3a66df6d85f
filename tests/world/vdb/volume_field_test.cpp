#include "world/vdb_import/volume_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/world/vdb/volumes.h"

namespace skerry::world {
namespace {

/// The value of an index by looking at every part.
float by_search(const VolumeGrid& grid, IVec3 at) {
  const auto in = [at](IVec3 low, std::int32_t edge) {
    return at.x >= low.x && at.x < low.x + edge && at.y >= low.y && at.y < low.y + edge &&
           at.z >= low.z && at.z < low.z + edge;
  };
  for (const VolumeBrick& brick : grid.bricks) {
    if (!in(brick.origin, kBrickEdge)) continue;
    const int i =
        (at.z - brick.origin.z) + 8 * (at.y - brick.origin.y) + 64 * (at.x - brick.origin.x);
    return brick.values[static_cast<std::size_t>(i)];
  }
  for (const VolumeTile& tile : grid.tiles)
    if (in(tile.origin, tile.edge)) return tile.value;
  return grid.background;
}

IVec3 random_index(Rng& random) {
  return {random.in(-50, 700), random.in(-140, 140), random.in(-140, 140)};
}

TEST(VolumeField, FindsTheValueOfEveryIndex) {
  VolumeGrid grid = random_volume(3, 60, 12);
  grid.background = 0.125f;
  const VolumeField field(grid);
  Rng random(4);
  for (int i = 0; i < 20'000; ++i) {
    const IVec3 at = random_index(random);
    ASSERT_EQ(field.at(at), by_search(grid, at)) << at.x << ' ' << at.y << ' ' << at.z;
  }
}

TEST(VolumeField, InterpolatesBetweenTheEightSamplesAround) {
  const VolumeGrid grid = random_volume(5, 200, 12);
  const VolumeField field(grid);
  Rng random(6);
  for (int i = 0; i < 5'000; ++i) {
    const glm::dvec3 place{random.in(-3300, 3300) * 0.01, random.in(-3300, 3300) * 0.01,
                           random.in(-3300, 3300) * 0.01};
    const glm::dvec3 low = glm::floor(place), part = place - low;
    double expected = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
      const double weight = (dx != 0 ? part.x : 1.0 - part.x) * (dy != 0 ? part.y : 1.0 - part.y) *
                            (dz != 0 ? part.z : 1.0 - part.z);
      expected +=
          weight * static_cast<double>(by_search(grid, {static_cast<std::int32_t>(low.x) + dx,
                                                        static_cast<std::int32_t>(low.y) + dy,
                                                        static_cast<std::int32_t>(low.z) + dz}));
    }
    ASSERT_NEAR(field.interpolated(place), expected, 1e-5);
  }
}

TEST(VolumeField, BoundsHoldEveryValueOfABox) {
  const VolumeGrid grid = random_volume(7, 60, 12);
  const VolumeField field(grid);
  Rng random(8);
  for (int i = 0; i < 2'000; ++i) {
    const IVec3 low = random_index(random);
    const int edge = 1 << random.in(0, 4);
    const IVec3 high{low.x + random.in(0, edge), low.y + random.in(0, edge),
                     low.z + random.in(0, edge)};
    const VolumeField::Range range = field.range(low, high);
    for (int k = 0; k < 40; ++k) {
      const float v = by_search(
          grid, {random.in(low.x, high.x), random.in(low.y, high.y), random.in(low.z, high.z)});
      ASSERT_LE(range.min, v);
      ASSERT_GE(range.max, v);
    }
  }
}

TEST(VolumeField, BoundsAreTightInsideATileAndFarFromAll) {
  VolumeGrid grid;
  grid.background = 2.0f;
  grid.tiles = {{{4096, 0, 0}, 4096, -1.0f}};
  const VolumeField field(grid);
  const VolumeField::Range inside = field.range({5000, 100, 100}, {5100, 900, 1100});
  EXPECT_EQ(inside.min, -1.0f);
  EXPECT_EQ(inside.max, -1.0f);
  const VolumeField::Range outside = field.range({-5000, 100, 100}, {-4000, 900, 1100});
  EXPECT_EQ(outside.min, 2.0f);
  EXPECT_EQ(outside.max, 2.0f);
}

TEST(VolumeField, BoundsReachFromEndToEndOfIndexSpace) {
  VolumeGrid grid;
  grid.background = 2.0f;
  grid.tiles = {{{4096, 0, 0}, 4096, -1.0f}};
  const VolumeField::Range all =
      VolumeField(grid).range({-kMaxVolumeIndex, -kMaxVolumeIndex, -kMaxVolumeIndex},
                              {kMaxVolumeIndex, kMaxVolumeIndex, kMaxVolumeIndex});
  EXPECT_EQ(all.min, -1.0f);
  EXPECT_EQ(all.max, 2.0f);
}

}  // namespace
}  // namespace skerry::world
