// Pixels that go to the picture at once against those that go through an image of radiance, and a
// sky that is worked out at some pixels against one at every pixel.
#include <algorithm>
#include <cmath>

#include "engine/render/air/air.h"
#include "engine/render/sky/sky_model.h"
#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{203, 121};  // no multiple of a tile, a run or a stride

/// A meadow with a pond.
world::BlockId pond(int x, int y, int z) {
  if (y >= 0)
    return (x * 5 + z * 3) % 17 == 0 && y == 0 ? world::block::kFern : world::block::kAirBlock;
  const bool water = y > -3 && x > 18 && x < 27 && z > 22 && z < 31;
  return water ? world::block::kWater : world::block::kGrass;
}

/// The same behind a wall, past which none of the water shows.
world::BlockId pond_behind_a_wall(int x, int y, int z) {
  if (z == 16 && y >= 0 && y < 9) return world::block::kStone;
  return pond(x, y, z);
}

int most_apart(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  EXPECT_EQ(a.size(), b.size());
  int most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(int{a[i]} - int{b[i]}));
  return most;
}

class ShadeTargets : public RendererOnGpu {
 protected:
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};

  FrameInput view() const {
    FrameInput in;
    in.islands = islands_;
    in.reach_blocks = 200.0;
    in.sky = sun_at(35.0, 200.0);
    in.camera = camera_at({22.0, 7.0, 2.0}, 10.0, -12.0, 80.0);
    in.exposure_ev = -1.0f;
    in.meter = true;
    return in;
  }
  /// Draws the picture at once, then by an image of radiance, and compares all that comes of it.
  void expect_one_picture(FrameInput in, int rate, bool water) {
    const std::vector<std::uint8_t> at_once = picture_of(in, rate);
    EXPECT_FALSE(has_pass("develop"));
    EXPECT_EQ(has_pass("refresh_picture"), water);
    const std::optional<float> ev = report_.metered_ev;
    const shared::PixelStats counts = report_.pixels;
    in.capture = true;
    const std::vector<std::uint8_t> by_radiance = picture_of(in, rate);
    EXPECT_TRUE(has_pass("develop"));
    EXPECT_FALSE(has_pass("refresh_picture"));
    // A sky of fewer pixels is mixed as it is encoded there, and as radiance here.
    EXPECT_LE(most_apart(at_once, by_radiance), rate == 1 ? 0 : 1);
    ASSERT_TRUE(ev.has_value());
    ASSERT_TRUE(report_.metered_ev.has_value());
    EXPECT_EQ(*ev, *report_.metered_ev);
    EXPECT_EQ(counts.black, report_.pixels.black);
    EXPECT_EQ(counts.non_finite, 0u);
  }
  std::vector<std::uint8_t> picture_of(const FrameInput& input, int rate) {
    RenderSettings settings;
    settings.shading_rate = rate;
    settings.meter.stride = 3;
    report_ = drawn(input, settings, kSize);
    return picture();
  }
  FrameReport report_;
};

TEST_F(ShadeTargets, TheWayToThePictureDoesNotShow) {
  add(pond, {0, -1, 0}, {1, 0, 1});
  struct Case {
    const char* name;
    Camera camera;
    bool water = true;
    std::uint32_t medium = world::block::kAirBlock;
  };
  const std::vector<Case> cases{
      {"over it", view().camera},
      {"far off, below which there is meadow", camera_at({22.0, 9.0, -27.0}, 0.0, -5.0, 40.0)},
      {"turned away", camera_at({22.0, 7.0, 40.0}, 10.0, -12.0, 80.0), false},
      {"inside", camera_at({22.0, -1.5, 26.0}, 10.0, 5.0, 80.0), true, world::block::kWater}};
  for (const Case& each : cases) {
    for (const int rate : {1, 2, 4}) {
      SCOPED_TRACE(testing::Message() << each.name << ", " << rate);
      FrameInput in = view();
      in.camera = each.camera;
      in.camera_medium = each.medium;
      expect_one_picture(in, rate, each.water);
    }
  }
}

TEST_F(ShadeTargets, WaterThatIsHiddenDoesNotShow) {
  add(pond_behind_a_wall, {0, -1, 0}, {1, 0, 1});
  for (const int rate : {1, 2, 4}) {
    SCOPED_TRACE(rate);
    expect_one_picture(view(), rate, true);
  }
}

TEST_F(ShadeTargets, CountsThatNobodyWantsDoNotChangeThePicture) {
  add(pond, {0, -1, 0}, {1, 0, 1});
  FrameInput in = view();
  in.sky = celestial_at(0.0, 0.0);  // a new moon: most of it is black
  const std::vector<std::uint8_t> counted = picture_of(in, 1);
  EXPECT_GT(report_.pixels.black, 0u);
  in.count_pixels = false;
  EXPECT_EQ(picture_of(in, 1), counted);
  EXPECT_EQ(report_.pixels.black, 0u);
}

TEST_F(ShadeTargets, ASkyOfFewerPixelsIsThatOfAll) {
  add(pond, {0, -1, 0}, {1, 0, 1});
  int plain_skies = 0;
  for (const double altitude : {-4.0, 0.5, 12.0, 60.0}) {
    for (const double azimuth : {180.0, 85.0, 78.0}) {
      SCOPED_TRACE(testing::Message() << altitude << ", " << azimuth);
      FrameInput in = view();
      in.sky = sun_at(altitude, azimuth);
      in.sky.to_moon = {0.0, -1.0, 0.0};
      in.camera = camera_at({22.0, 7.0, 40.0}, 10.0, 30.0, 100.0);
      in.exposure_ev.reset();
      RenderSettings every, fewer;
      fewer.shading_rate = 4;
      const std::vector<glm::vec4> truth = radiance(in, every, kSize);
      const std::vector<glm::vec4> some = radiance(in, fewer, kSize);
      const Captured depth = renderer().captured(Capture::kDepth);
      // Across the horizon light changes within a few pixels.
      constexpr double kHorizonBand = 0.06;  // rad: four pixels
      const double horizon = std::asin(horizon_sine(eye_height_km(in)));
      double most = 0.0, most_at_horizon = 0.0;
      int sky = 0;
      for (std::size_t i = 0; i < truth.size(); ++i) {
        float surface = 0.0f;
        std::memcpy(&surface, depth.texels.data() + 4 * i, 4);
        if (surface != 0.0f) continue;
        ++sky;
        const glm::dvec3 ray =
            glm::normalize(ray_of(in.camera, static_cast<double>(i % kSize.width),
                                  static_cast<double>(i / kSize.width), kSize.width, kSize.height));
        double& worst =
            std::abs(std::asin(ray.y) - horizon) < kHorizonBand ? most_at_horizon : most;
        for (int c = 0; c < 3; ++c)
          if (truth[i][c] > 1e-4f)
            worst =
                std::max(worst, double{std::abs(some[i][c] - truth[i][c])} / double{truth[i][c]});
      }
      EXPECT_LT(most_at_horizon, 0.1);
      EXPECT_GT(sky, 203 * 121 / 3);
      EXPECT_LT(most, 0.02);  // one column too far is an error of 0.03 to 0.1
      plain_skies += most > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(plain_skies, 6);
}

// Tiles in which none can be seen are mixed, those in which some can are not.
TEST_F(ShadeTargets, StarsAndDiscsAreThoseOfAllPixels) {
  add(pond, {0, -1, 0}, {1, 0, 1});
  std::size_t bright = 0, mixed = 0;
  for (const double fov : {3.0, 12.0, 40.0, 100.0}) {
    for (const double yaw : {0.0, 133.0, 221.0}) {
      for (const double pitch : {4.0, 35.0, 75.0}) {
        if (fov > 50.0 && pitch < 60.0) continue;  // a horizon within few pixels: see above
        SCOPED_TRACE(testing::Message() << fov << ", " << yaw << ", " << pitch);
        FrameInput in = view();
        in.sky = celestial_at(0.0, 0.5);
        in.camera = camera_at({22.0, 7.0, 40.0}, yaw, pitch, fov);
        if (yaw == 133.0 && pitch > 70.0) {
          const glm::dvec3 moon = in.sky.to_moon;
          in.camera = camera_at({22.0, 7.0, 40.0}, glm::degrees(std::atan2(moon.x, moon.z)),
                                glm::degrees(std::asin(moon.y)), fov);
        }
        in.exposure_ev.reset();
        RenderSettings every, fewer;
        fewer.shading_rate = 4;
        const std::vector<glm::vec4> truth = radiance(in, every, kSize);
        const std::vector<glm::vec4> some = radiance(in, fewer, kSize);
        std::vector<float> levels;
        for (const glm::vec4& pixel : truth) levels.push_back(pixel.y);
        std::nth_element(levels.begin(), levels.begin() + levels.size() / 2, levels.end());
        const float middle = levels[levels.size() / 2];
        float most = 0.0f;
        for (std::size_t i = 0; i < truth.size(); ++i) {
          const float apart = std::abs(some[i].y - truth[i].y);
          most = std::max(most, apart / (truth[i].y + middle));
          bright += truth[i].y > 3.0f * middle ? 1 : 0;
          mixed += apart > 0.0f ? 1 : 0;
        }
        EXPECT_LT(most, 0.02f);
      }
    }
  }
  EXPECT_GT(bright, 1000u);
  EXPECT_GT(mixed, 30000u);
}

}  // namespace
}  // namespace skerry::render
