// Dark by default: where no light reaches, radiance is exactly zero.
#include "tests/render/renderer_on_gpu.h"

#include <algorithm>

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{96, 72};
constexpr std::uint32_t kPixels = kSize.width * kSize.height;

/// Altitudes and azimuths [degrees].
const std::vector<std::pair<double, double>> kSuns{{60, 0}, {45, 130}, {30, 77}, {20, 250}};

/// A hollow box of stone: inside [low, high), walls of this many blocks around it.
BlockAt room(int low, int high, int wall, int water_below) {
  return [=](int x, int y, int z) -> world::BlockId {
    const int least = std::min({x, y, z}), most = std::max({x, y, z});
    if (least < low - wall || most >= high + wall) return world::block::kAirBlock;
    if (least < low || most >= high) return world::block::kStone;
    return y < water_below ? world::block::kWater : world::block::kAirBlock;
  };
}

class Darkness : public RendererOnGpu {
 protected:
  double reach_blocks_ = FrameInput{}.reach_blocks;

  /// Every pixel of views in six directions under several suns is black before tone mapping, and
  /// so is the picture.
  void expect_black(glm::dvec3 eye, std::uint32_t medium, const RenderSettings& settings,
                    const std::vector<std::pair<double, double>>& suns = kSuns) {
    const std::vector<IslandPlacement> islands{
        {{}, glm::angleAxis(0.3, glm::dvec3(0.0, 1.0, 0.0)), 300.0}};
    FrameInput input;
    input.islands = islands;
    input.reach_blocks = reach_blocks_;
    input.camera_medium = medium;
    const glm::dvec3 place = islands[0].rotation * eye;
    for (const auto& [altitude, azimuth] : suns) {
      input.sky = sun_at(altitude, azimuth);
      for (const auto& [yaw, pitch] : std::vector<std::pair<double, double>>{
               {10, 0}, {100, -20}, {190, 20}, {280, -5}, {45, 85}, {45, -85}}) {
        input.camera = camera_at(place, yaw, pitch, 90.0);
        const FrameReport report = drawn(input, settings, kSize);
        EXPECT_EQ(report.pixels.black, kPixels)
            << "sun at " << altitude << ", " << azimuth << "; view " << yaw << ", " << pitch;
        EXPECT_EQ(report.pixels.non_finite, 0u);
        const std::vector<std::uint8_t> pixels = picture();
        std::size_t lit = 0;
        for (std::size_t i = 0; i < pixels.size(); i += 4)
          lit += pixels[i] != 0 || pixels[i + 1] != 0 || pixels[i + 2] != 0 ? 1 : 0;
        EXPECT_EQ(lit, 0u);
      }
    }
  }
  /// The check itself can fail: outside, the same walls are lit.
  void expect_light_outside(glm::dvec3 eye) {
    const std::vector<IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
    FrameInput input;
    input.islands = islands;
    input.sky = sun_at(60.0, 0.0);
    input.camera = camera_at(eye, 0.0, -89.0);
    EXPECT_EQ(drawn(input, {}, kSize).pixels.black, 0u);
  }
};

TEST_F(Darkness, ASealedRoomIsBlackUnderAnySun) {
  add(room(20, 30, 1, 0), {0, 0, 0}, {1, 1, 1});
  expect_black({25.3, 24.1, 26.2}, 0, {});
  expect_light_outside({25.3, 50.0, 26.2});
}

TEST_F(Darkness, ASealedRoomInsideALargeSolidIsBlack) {
  add(room(40, 80, 40, 0), {0, 0, 0}, {2, 2, 2});
  expect_black({62.3, 55.1, 70.2}, 0, {});
  expect_light_outside({62.3, 130.0, 70.2});
}

TEST_F(Darkness, WaterInASealedRoomIsBlackFromAboveAndBelow) {
  add(room(20, 30, 1, 24), {0, 0, 0}, {1, 1, 1});
  expect_black({25.3, 26.6, 26.2}, 0, {});
  expect_black({25.3, 22.6, 26.2}, world::block::kWater, {});
}

TEST_F(Darkness, ASealedRoomStaysBlackAtLowQuality) {
  add(room(20, 30, 2, 0), {0, 0, 0}, {1, 1, 1});
  RenderSettings settings;
  reach_blocks_ = 400.0;
  settings.shadow_size = 1024;
  expect_black({25.3, 24.1, 26.2}, 0, settings);
}

// Where light grazes a wall, the shadow filter's plane reaches far along it.
TEST_F(Darkness, ASealedRoomIsBlackUnderASunThatGrazesItsWalls) {
  add(room(20, 30, 1, 0), {0, 0, 0}, {1, 1, 1});
  expect_black({25.3, 24.1, 26.2}, 0, {}, {{90, 0}, {60, 17.2}, {5, 200}, {0.5, 310}});
}

// A roof of quads of all sizes has T-junctions at nearly every corner; no light may come through.
TEST_F(Darkness, ASealedRoomUnderARoofOfManyKindsIsBlack) {
  add(
      [](int x, int y, int z) -> world::BlockId {
        const world::BlockId block = room(4, 60, 3, 0)(x, y, z);
        if (block != world::block::kStone) return block;
        return (x * 7 + z * 13 + x * z / 5) % 5 < 2 ? world::block::kStone : world::block::kDirt;
      },
      {0, 0, 0}, {1, 1, 1});
  expect_black({25.3, 24.1, 26.2}, 0, {});
}

// As far as the coarsest of the shadow maps, whose texels are larger than the walls are thick.
TEST_F(Darkness, ASealedHallIsBlackToItsFarEnd) {
  add(
      [](int x, int y, int z) -> world::BlockId {
        const auto inside = [&](int more) {
          return std::min(x, y) >= 20 - more && std::max(x, y) < 44 + more && z >= 20 - more &&
                 z < 620 + more;
        };
        return inside(1) && !inside(0) ? world::block::kStone : world::block::kAirBlock;
      },
      {0, 0, 0}, {1, 1, 10});
  expect_black({32.3, 32.1, 26.2}, 0, {});
}

TEST_F(Darkness, ANightWithoutMoonIsBlackOnEverySurface) {
  add(room(0, 64, 0, 10), {0, 0, 0}, {1, 1, 1});
  const std::vector<IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  FrameInput input;
  input.islands = islands;
  input.sky = celestial_at(0.0, 0.0);
  add([](int, int y, int) -> world::BlockId { return y < 0 ? world::block::kGrass : 0; },
      {-1, -1, -1}, {2, 0, 2});
  input.camera = camera_at({-10.0, 12.0, -10.0}, 45.0, -60.0, 60.0);
  EXPECT_EQ(drawn(input, {}, kSize).pixels.black, kPixels);
}

}  // namespace
}  // namespace skerry::render
