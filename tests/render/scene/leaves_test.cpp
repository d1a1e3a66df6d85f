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

/// A wall of leaves against the light, from so far that its texture has few texels a pixel or one.
TEST_F(Leaves, HaveAsManyHolesFromAfar) {
  constexpr VkExtent2D kSize{96, 96};
  add(
      [](int, int, int z) -> world::BlockId {
        return z == 180 ? world::block::kOakLeaves : world::block::kAirBlock;
      },
      {-1, -1, 2}, {1, 1, 3});
  const std::vector<IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 400.0}};
  FrameInput input;
  input.islands = islands;
  input.sky = sun_at(60.0, 0.0);  // behind it
  RenderSettings settings;
  settings.shadow_enabled = false;
  settings.leave_out.add(Feature::kHaze);
  // Of 4, 2.1, 1.4, 1.2, 0.83, 0.59 and 0.46 pixels a block.
  for (const double blocks : {20.7, 40.3, 60.1, 70.3, 100.7, 141.3, 180.0}) {
    input.camera = camera_at({0.3, 0.4, 180.0 - blocks}, 0.0, 0.0, 60.0);
    const std::vector<glm::vec4> picture = radiance(input, settings, kSize);
    int dark = 0, seen = 0;
    for (std::uint32_t y = 28; y < 68; ++y) {
      for (std::uint32_t x = 28; x < 68; ++x) {
        dark += picture[x + kSize.width * y].y == 0.0f;
        ++seen;
      }
    }
    EXPECT_NEAR(dark, 0.75 * seen, 0.06 * seen) << blocks;
  }
}

}  // namespace
}  // namespace skerry::render
