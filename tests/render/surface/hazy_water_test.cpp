// Air before water and glass: it dims and lights them as it does what is opaque.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{32, 32};
constexpr double kExtinction = 0.0005;  // of clear air by day, one a block

class HazyWater : public RendererOnGpu {
 protected:
  /// Radiance in the middle of a picture of a wall of one block, from so many blocks away.
  glm::dvec3 of_wall(world::BlockId block, double blocks, bool haze) {
    restart();
    add(
        [block](int, int, int z) -> world::BlockId {
          return z >= 30 ? block : world::BlockId{world::block::kAirBlock};
        },
        {-1, -1, 0}, {1, 1, 1});
    FrameInput in;
    in.islands = islands_;
    in.sky = sun_at(50.0, 200.0);
    in.camera = camera_at({0.5, 6.5, 30.0 - blocks}, 0.0, 0.0);
    in.camera.fov_deg = 0.1;
    RenderSettings settings;
    settings.shadow_enabled = false;  // maps end before such walls
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

}  // namespace
}  // namespace skerry::render
