// Foam along the shore of a pond, against the distance to all land about it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/render/renderer_on_gpu.h"
#include "world/voxel/blocks.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{96, 96};
constexpr double kHigh = 40.0, kSun = 3000.0;

/// Columns of stone that stand in water as if at random.
bool is_land(int x, int z) {
  const auto hash =
      static_cast<std::uint32_t>(x * 73856093) ^ static_cast<std::uint32_t>(z * 19349663);
  return hash * 2654435761u >> 29 < 2u;
}
world::BlockId pond(int x, int y, int z) {
  if (y >= 0) return world::block::kAirBlock;
  return y < -3 || is_land(x, z) ? world::block::kStone : world::block::kWater;
}

double distance_to_land(double x, double z) {
  double least = 9.0;
  for (int u = -2; u <= 2; ++u)
    for (int v = -2; v <= 2; ++v) {
      const double column_x = std::floor(x) + u, column_z = std::floor(z) + v;
      if (!is_land(static_cast<int>(column_x), static_cast<int>(column_z))) continue;
      least = std::min(least, std::hypot(std::max({column_x - x, x - column_x - 1.0, 0.0}),
                                         std::max({column_z - z, z - column_z - 1.0, 0.0})));
    }
  return least;
}

class Foam : public RendererOnGpu {
 protected:
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};

  /// Upright down, under a sun so bright that nothing else counts, and not mirrored to the eye.
  FrameInput view() {
    FrameInput in;
    in.islands = islands_;
    in.reach_blocks = 400.0;
    in.time_s = 7.3;
    in.sky = celestial_at(0.5 * kDaySeconds, 0.0);
    in.sky.to_sun = {0.8, 0.6, 0.0};
    in.sky.sun_irradiance = glm::vec3(kSun);
    in.camera = camera_at({32.0, kHigh, 32.0}, 0.0, -90.0, 14.0);
    return in;
  }
};

TEST_F(Foam, CoversWaterByItsDistanceToLand) {
  RenderSettings settings;
  settings.indirect = Indirect::kOff;
  settings.ao_strength = 0.0f;
  settings.water_mirror = WaterMirror::kSky;
  const FrameInput in = view();
  add(pond, {0, -1, 0}, {1, 0, 1});
  const std::vector<glm::vec4> without = radiance(in, settings, kSize);
  add_occupancy(pond, {0, -1, 0}, {1, 0, 1});
  const std::vector<glm::vec4> with = radiance(in, settings, kSize);
  const double turn = 2.0 * std::numbers::pi * in.time_s;
  int foamy = 0, clear = 0;
  for (std::uint32_t y = 0; y < kSize.height; ++y)
    for (std::uint32_t x = 0; x < kSize.width; ++x) {
      const glm::dvec3 ray = ray_of(in.camera, x, y, kSize.width, kSize.height);
      const double at_x = 32.0 - kHigh * ray.x / ray.y, at_z = 32.0 - kHigh * ray.z / ray.y;
      const double land = distance_to_land(at_x, at_z);
      if (land < 0.08) continue;  // and pixels that show some of it
      const double width = 0.2 + 0.06 * std::sin(2.7 * at_x + 1.9 * at_z + 0.25 * turn) +
                           0.05 * std::sin(-3.8 * at_x + 4.6 * at_z + 0.4 * turn);
      const double away = kHigh * glm::length(ray) / -ray.y;
      const double cover =
          0.8 * std::clamp((width - land) / (0.6 * width), 0.0, 1.0) * std::exp(-0.02 * away);
      const glm::vec4 &before = without[y * kSize.width + x], &after = with[y * kSize.width + x];
      const double foam = 0.8 / std::numbers::pi * 0.6 * kSun;
      EXPECT_NEAR((after.z - before.z) / (foam - before.z), cover, 0.01) << x << ", " << y;
      ++(cover > 0.1 ? foamy : clear);
    }
  EXPECT_GT(foamy, 500);
  EXPECT_GT(clear, 500);
}

}  // namespace
}  // namespace skerry::render
