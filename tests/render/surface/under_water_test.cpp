// Light on the bed of a lake, against Snell's, Fresnel's and Beer's laws.
#include <array>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "tests/render/renderer_on_gpu.h"
#include "tests/water_laws.h"
#include "world/voxel/blocks.h"

namespace skerry::render {
namespace {

using water_laws::bent_cosine;
using water_laws::fresnel_at;
using water_laws::kIndex;
using water_laws::mirrored_back;

constexpr VkExtent2D kSize{97, 97};
constexpr double kDeep = 4.0, kHigh = 120.0;
constexpr double kSun = 3000.0;         // irradiance
constexpr double kHazeABlock = 0.0005;  // what clear air takes by day
constexpr int kRoofEnd = 32;            // x

world::BlockId lake(int, int y, int) {
  if (y >= 0) return world::block::kAirBlock;
  return y >= -4 ? world::block::kWater : world::block::kStone;
}
world::BlockId dry(int x, int y, int z) {
  const world::BlockId block = lake(x, y, z);
  return block == world::block::kWater ? world::BlockId{world::block::kAirBlock} : block;
}
world::BlockId roofed(int x, int y, int z) {
  return y == 5 && x < kRoofEnd ? world::BlockId{world::block::kStone} : lake(x, y, z);
}
world::BlockId reef(int x, int y, int z) {
  return y == -3 && x < kRoofEnd ? world::BlockId{world::block::kStone} : lake(x, y, z);
}

const std::array<float, 3>& kAbsorption = world::block_types()[world::block::kWater].absorption;
const double kScattering =
    static_cast<double>(world::block_types()[world::block::kWater].scattering);
glm::dvec3 extinction_of_water() {
  return glm::dvec3(kAbsorption[0], kAbsorption[1], kAbsorption[2]) + kScattering;
}
class UnderWater : public RendererOnGpu {
 protected:
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};

  double middle_ = 0.0;  // x of the picture's middle

  /// Upright down from so far that there are no ripples. The sun is so bright that nothing else
  /// counts.
  FrameInput view(double degrees, double x = 32.0) {
    const double angle = glm::radians(degrees);
    FrameInput in;
    in.islands = islands_;
    in.reach_blocks = 400.0;
    in.sky = celestial_at(0.5 * kDaySeconds, 0.0);
    in.sky.to_sun = {-std::sin(angle), std::cos(angle), 0.0};
    in.sky.sun_irradiance = glm::vec3(kSun);
    middle_ = x;
    in.camera = camera_at({x, kHigh, 32.0}, 0.0, -90.0, 8.0);
    return in;
  }
  glm::dvec3 mean(const FrameInput& in) {
    glm::dvec3 sum(0.0);
    const std::vector<glm::vec4> seen = radiance(in, {}, kSize);
    for (const glm::vec4& pixel : seen) sum += glm::dvec3(pixel);
    return sum / double(seen.size());
  }
  /// Where along x, in the picture's middle row, the bed is lit from, up to the picture's left
  /// edge.
  double lit_from(const FrameInput& in) {
    const std::vector<glm::vec4> seen = radiance(in, {}, kSize);
    const glm::vec4* row = &seen[std::size_t{kSize.width} * (kSize.height / 2)];
    const float lit = row[0].z;
    std::uint32_t x = 0;
    while (x < kSize.width && row[x].z > 0.5f * lit) ++x;
    EXPECT_GT(lit, 1.0f);
    const glm::dvec3 ray = ray_of(in.camera, x - 0.5, kSize.height / 2, kSize.width, kSize.height);
    // The middle of the picture is where no ray is bent.
    return middle_ + (kHigh + kDeep) * ray.x / -ray.y;
  }
};

TEST_F(UnderWater, ABedHasWhatFresnelAndBeerLeaveOfTheSun) {
  for (const double degrees : {20.0, 45.0, 70.0}) {
    restart();
    add(dry, {0, -1, 0}, {1, 0, 1});
    const glm::dvec3 without = mean(view(degrees));
    restart();
    add(lake, {0, -1, 0}, {1, 0, 1});
    const glm::dvec3 with = mean(view(degrees));
    const double cosine = std::cos(glm::radians(degrees));
    const glm::dvec3 extinction = extinction_of_water();
    for (int c = 0; c < 3; ++c) {
      const double up = std::exp(-kDeep * extinction[c]);
      const double down =
          (1.0 - fresnel_at(cosine)) * std::exp(-kDeep / bent_cosine(cosine) * extinction[c]);
      // What the water itself scatters of the light that falls on it: docs/conventions.md.
      const double sent =
          kSun * cosine * kScattering / extinction[c] * (1.0 - up) / (4.0 * std::numbers::pi);
      const double albedo = without[c] * std::numbers::pi / (kSun * cosine);
      const double again = 1.0 / (1.0 - albedo * mirrored_back(kDeep * extinction[c]));
      // The bed has been seen through the air already. Radiance goes with the square of the index.
      const double expected =
          (1.0 - fresnel_at(1.0)) / (kIndex * kIndex) *
          (without[c] * up * down * again + sent * std::exp(-kHazeABlock * kHigh));
      EXPECT_NEAR(with[c], expected, 0.03 * expected) << degrees << " degrees, channel " << c;
    }
  }
}

TEST_F(UnderWater, AShadowFallsWhereTheBentLightIsMissing) {
  constexpr double kDegrees = 60.0;
  const double slope = std::tan(glm::radians(kDegrees));
  const double bent = std::tan(std::asin(std::sin(glm::radians(kDegrees)) / kIndex));
  // Of a roof whose upper side is six blocks above the water.
  const double roof = kRoofEnd + 6.0 * slope + kDeep * bent;
  add(roofed, {0, -1, 0}, {1, 1, 1});
  EXPECT_NEAR(lit_from(view(kDegrees, roof)), roof, 0.4);  // half of its soft edge
  // Of something under water: the renderer looks for it on the straight way, within two texels.
  restart();
  add(reef, {0, -1, 0}, {1, 0, 1});
  const double under = lit_from(view(kDegrees, kRoofEnd + 2.0));
  EXPECT_GT(under, kRoofEnd + 2.0 * bent - 0.3);
  EXPECT_LT(under, kRoofEnd + 2.0 * slope + 0.3);
}

}  // namespace
}  // namespace skerry::render
