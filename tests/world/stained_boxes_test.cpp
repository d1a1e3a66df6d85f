#include "world/mesh/stained_boxes.h"

#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <map>
#include <random>

namespace skerry::world {
namespace {

TEST(StainedBoxes, CoverEachVoxelOnceWithItsBlock) {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    // Panes through one another, and single voxels.
    std::map<std::uint32_t, BlockId> glass;
    const auto in = [&](int low, int high) {
      return low + static_cast<int>(random() % static_cast<unsigned>(high - low));
    };
    for (int pane = 0; pane < 12; ++pane) {
      const glm::ivec3 low(in(0, 60), in(0, 60), in(0, 60));
      const glm::ivec3 end = glm::min(low + glm::ivec3(in(1, 20), in(1, 9), in(1, 20)), 64);
      const BlockId block = pane % 2 == 0 ? block::kRedGlass : block::kSkyGlass;
      for (int y = low.y; y < end.y; ++y)
        for (int x = low.x; x < end.x; ++x)
          for (int z = low.z; z < end.z; ++z)
            if (round % 2 == 0 || in(0, 3) == 0)
              glass[static_cast<std::uint32_t>(y << 12 | x << 6 | z)] = block;
    }
    std::vector<StainedVoxel> voxels;
    for (const auto& [place, block] : glass) voxels.push_back({place, block});
    std::size_t covered = 0;
    for (const StainedBox& box : stained_boxes_of(voxels))
      for (int y = box.low.y; y < box.low.y + box.size.y; ++y)
        for (int x = box.low.x; x < box.low.x + box.size.x; ++x)
          for (int z = box.low.z; z < box.low.z + box.size.z; ++z) {
            const auto place = static_cast<std::uint32_t>(y << 12 | x << 6 | z);
            ASSERT_TRUE(glass.contains(place) && glass.at(place) == box.block);
            glass.erase(place);  // a second box over it fails
            ++covered;
          }
    EXPECT_EQ(covered, voxels.size());
  }
}

TEST(StainedBoxes, OfAPaneThereIsOne) {
  std::vector<StainedVoxel> voxels;
  for (std::uint32_t y = 10; y < 14; ++y)
    for (std::uint32_t x = 0; x < 64; ++x)
      voxels.push_back({y << 12 | x << 6 | 5, block::kRedGlass});
  const std::vector<StainedBox> expected{{{0, 10, 5}, {64, 4, 1}, block::kRedGlass}};
  EXPECT_EQ(stained_boxes_of(voxels), expected);
  EXPECT_TRUE(stained_boxes_of({}).empty());
}

}  // namespace
}  // namespace skerry::world
