#include <gtest/gtest.h>

#include "tests/render/renderer_on_gpu.h"
#include "world/voxel/blocks.h"

namespace skerry::render {
namespace {

using Leaves = RendererOnGpu;

/// A leaf seen through its own holes, alone and with a block behind the camera, in the same chunk.
TEST_F(Leaves, ShowNoBacksWhateverElseStandsInTheirChunk) {
  constexpr VkExtent2D kSize{96, 96};
  const std::vector<IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 200.0}};
  FrameInput input;
  input.camera = camera_at({8.7, 8.6, 38.5}, 0.0, 0.0, 60.0);
  input.islands = islands;
  input.sky = sun_at(60.0, 200.0);
  RenderSettings settings;
  settings.shadow_enabled = false;
  const auto pictured = [&](bool leaf, bool block_behind) {
    restart();
    add(
        [&](int x, int y, int z) -> world::BlockId {
          if (x != 8 || y != 8) return world::block::kAirBlock;
          if (leaf && z == 40) return world::block::kOakLeaves;
          return block_behind && z == 10 ? world::block::kStone : world::block::kAirBlock;
        },
        {0, 0, 0}, {1, 1, 1});
    drawn(input, settings, kSize);
    return picture();
  };
  const std::vector<std::uint8_t> alone = pictured(true, false);
  EXPECT_NE(alone, pictured(false, true));
  EXPECT_EQ(alone, pictured(true, true));
}

}  // namespace
}  // namespace skerry::render
