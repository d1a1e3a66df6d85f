// Where the bed of a lake is seen, against Snell's law.
#include <cmath>
#include <glm/trigonometric.hpp>

#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{121, 97};
constexpr double kDepth = 4.0, kEdge = 16.0;  // of the bed; where lamps end on it, along z

world::BlockId lake(int, int y, int z) {
  if (y >= 0) return world::block::kAirBlock;
  if (y >= -4) return world::block::kWater;
  return y == -5 && z < 16 ? world::block::kLamp : world::block::kStone;
}

class BentLight : public RendererOnGpu {
 protected:
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};

  /// From so far that ripples turn no ray by more than a hundredth of a block.
  FrameInput view(double pitch_deg) const {
    const double pitch = glm::radians(pitch_deg);
    FrameInput in;
    in.islands = islands_;
    in.reach_blocks = 400.0;
    in.sky = celestial_at(0.0, 0.0);
    in.camera = camera_at({16.0, 120.0 * std::sin(pitch), kEdge - 120.0 * std::cos(pitch)}, 0.0,
                          -pitch_deg, 8.0);
    return in;
  }
};

TEST_F(BentLight, ABedIsSeenWhereSnellsLawHasIt) {
  add(lake, {0, -1, 0}, {1, 0, 1});
  for (const double pitch : {25.0, 45.0, 70.0}) {
    const FrameInput in = view(pitch);
    const std::vector<glm::vec4> seen = radiance(in, {}, kSize);
    const glm::dvec3 eye(16.0, 120.0 * std::sin(glm::radians(pitch)),
                         kEdge - 120.0 * std::cos(glm::radians(pitch)));
    int lamps = 0, stones = 0;
    for (std::uint32_t y = 24; y < kSize.height - 24; ++y) {
      const std::uint32_t x = kSize.width / 2;
      const glm::dvec3 ray = glm::normalize(ray_of(in.camera, x, y, kSize.width, kSize.height));
      const double sine = std::hypot(ray.x, ray.z) / 1.333;
      const double surface = eye.z - eye.y / ray.y * ray.z;
      const double bed = surface + kDepth * sine / std::sqrt(1.0 - sine * sine);
      if (std::abs(bed - kEdge) < 0.3) continue;  // some pixels, and what ripples turn
      const bool lamp = bed < kEdge;
      EXPECT_EQ(seen[y * kSize.width + x].x > 0.2f, lamp)
          << pitch << " degrees, row " << y << ", " << bed << ": " << seen[y * kSize.width + x].x;
      ++(lamp ? lamps : stones);
    }
    EXPECT_GT(lamps, 5);
    EXPECT_GT(stones, 5);
  }
}

}  // namespace
}  // namespace skerry::render
