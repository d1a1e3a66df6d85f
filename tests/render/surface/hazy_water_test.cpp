// Air before water and glass: it dims and lights them as it does what is opaque.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/exponential.hpp>

#include "tests/render/extinction.h"
#include "tests/render/renderer_on_gpu.h"
#include "tools/reference/textures.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{32, 32};
constexpr double kExtinction = 0.0005;  // of clear air by day, one a block

/// Where the camera and what it looks at stand: in the middle of a texel.
constexpr double kX = 16.5 / 32.0, kY = 6.0 + 16.5 / 32.0;
constexpr int kToPane = 10;

/// What a pane of one block lets through at right angles: Fresnel's share twice, what its film
/// covers there, Beer's law.
glm::dvec3 through_pane(world::BlockId glass) {
  const glm::dvec4 texel = reference::BlockTexels::shared().texel(glass, 5, {kX, kY, 0.0});
  constexpr double kReflected = (0.333 / 2.333) * (0.333 / 2.333);
  return std::pow((1.0 - kReflected) * (1.0 - texel.w), 2.0) * glm::exp(-extinction_of(glass));
}

class HazyWater : public RendererOnGpu {
 protected:
  /// Radiance in the middle of a picture of a wall of one block, from so many blocks away.
  /// @param pane of glass ten blocks before the camera.
  glm::dvec3 of_wall(world::BlockId block, double blocks, bool haze,
                     world::BlockId pane = world::block::kAirBlock) {
    restart();
    const int pane_z = 30 - static_cast<int>(blocks) + kToPane;
    const auto block_at = [=](int, int, int z) -> world::BlockId {
      if (z == pane_z) return pane;
      return z >= 30 ? block : world::BlockId{world::block::kAirBlock};
    };
    add(block_at, {-1, -1, 0}, {1, 1, 1});
    const int chunk = static_cast<int>(std::floor(pane_z / 64.0));
    if (pane != world::block::kAirBlock && chunk != 0)
      add(block_at, {-1, -1, chunk}, {1, 1, chunk + 1});
    FrameInput in;
    in.islands = islands_;
    in.sky = sun_at(50.0, 200.0);
    in.camera = camera_at({kX, kY, 30.0 - blocks}, 0.0, 0.0);
    in.camera.fov_deg = 0.1;
    RenderSettings settings;
    settings.shadow_enabled = false;  // maps end before such walls
    settings.water_layers = 3;        // both sides of the pane, and the wall
    if (!haze) settings.leave_out.add(Feature::kHaze);
    const std::vector<glm::vec4> picture = radiance(in, settings, kSize);
    glm::dvec3 sum(0.0);
    for (const glm::vec4& pixel : picture) sum += glm::dvec3(pixel);
    return sum / static_cast<double>(picture.size());
  }
  /// What the air between eye and wall sends: what is left of the radiance where the wall's share
  /// is taken off.
  glm::dvec3 of_air(world::BlockId block, double blocks) {
    const double clear = std::exp(-kExtinction * blocks);
    return of_wall(block, blocks, true) - clear * of_wall(block, blocks, false);
  }
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
};

TEST_F(HazyWater, AirBeforeItIsThatBeforeAWall) {
  for (const double blocks : {200.0, 1'000.0, 4'000.0, 12'000.0}) {
    const glm::dvec3 wall = of_air(world::block::kBricks, blocks);
    for (const world::BlockId block : {world::block::kWater, world::block::kGlass}) {
      const glm::dvec3 seen = of_air(block, blocks);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(seen[c], wall[c], 0.03 * wall[c] + 0.002)
            << "block " << block << ", " << blocks << " blocks, channel " << c;
    }
  }
}

TEST_F(HazyWater, BehindAPaneItIsColouredByThePane) {
  constexpr double kBlocks = 1'000.0;
  constexpr world::BlockId kPane = world::block::kRedGlass, kWall = world::block::kBricks;
  const glm::dvec3 through = through_pane(kPane);
  EXPECT_GT(through.x, 5.0 * through.y);
  const double near = std::exp(-kExtinction * kToPane), far = std::exp(-kExtinction * kBlocks);
  const glm::dvec3 air = of_air(kWall, kBlocks), near_air = of_air(kWall, kToPane);
  // What the pane itself sends.
  const glm::dvec3 pane =
      of_wall(kWall, kBlocks, false, kPane) - through * of_wall(kWall, kBlocks, false);
  for (const world::BlockId block : {kWall, world::BlockId{world::block::kWater}}) {
    const glm::dvec3 sent = of_wall(block, kBlocks, false, kPane) - pane;
    const glm::dvec3 expected =
        near * pane + far * sent + through * air + (1.0 - through) * near_air;
    const glm::dvec3 seen = of_wall(block, kBlocks, true, kPane);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(seen[c], expected[c], 0.02 * expected[c] + 0.002)
          << "block " << block << ", channel " << c;
    // Not lost in the tolerance.
    EXPECT_GT(through.x * air.x, 0.1 * expected.x);
  }
}

}  // namespace
}  // namespace skerry::render
