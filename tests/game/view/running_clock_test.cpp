// The clock of play runs at 24 times the world's: what a frame of it changes in the picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <glm/geometric.hpp>

#include "engine/gpu/transfer/readback.h"
#include "game/input/controls.h"
#include "game/view/scene_view.h"
#include "shaders/shared/sky.h"
#include "tests/gpu/test_device.h"
#include "tests/render/random_scenes.h"

namespace skerry::game {
namespace {

constexpr VkExtent2D kSize{128, 72};
constexpr double kFrameS = 1.0 / 60.0, kDayRate = 24.0;
using Bytes = std::vector<std::byte>;

class RunningClock : public gpu::GpuTest {
 protected:
  RunningClock() : GpuTest(gpu::Checks::kAllInLongRuns) {}
  /// Towards the place on the horizon where the sun sets, without shadows, whose edges move.
  void look_west() {
    SceneOptions options;
    options.seed_text = "1";
    options.settings.view_distance = 200;
    options.settings.render.shadow_enabled = false;
    Result<std::unique_ptr<SceneView>> made = SceneView::create(device(), options);
    ASSERT_TRUE(made) << made.error().message;
    view_ = *std::move(made);
    moment_.camera = view_->start_camera();
    moment_.camera.yaw_deg = 270.0;
    moment_.camera.pitch_deg = 5.0;
    ASSERT_TRUE(view_->load_completely(moment_));
  }

  Bytes picture(int time_of_day_s) {
    moment_.time_of_day_s = time_of_day_s;
    EXPECT_TRUE(view_->draw(moment_, kSize));
    view_->renderer().finish();
    Result<Bytes> bytes = gpu::read_back(device(), view_->renderer().picture(), 4);
    EXPECT_TRUE(bytes);
    return bytes ? *std::move(bytes) : Bytes{};
  }

  /// The greatest change of a pixel that is not at the sun's disc, which moves.
  int change(const Bytes& a, const Bytes& b, int time_of_day_s) const {
    const glm::dvec3 to_sun = render::celestial_at(time_of_day_s, 0.0).to_sun;
    const double beside = std::cos(static_cast<double>(shared::kDiscRadius) + 0.02);
    int most = 0;
    for (std::uint32_t y = 0; y < kSize.height; ++y)
      for (std::uint32_t x = 0; x < kSize.width; ++x) {
        const glm::dvec3 ray = render::ray_of(moment_.camera, x, y, kSize.width, kSize.height);
        if (glm::dot(glm::normalize(ray), to_sun) > beside) continue;
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t at = (std::size_t{y} * kSize.width + x) * 4 + c;
          most =
              std::max(most, std::abs(std::to_integer<int>(a[at]) - std::to_integer<int>(b[at])));
        }
      }
    return most;
  }

  std::unique_ptr<SceneView> view_;
  SceneView::Moment moment_;
};

TEST_F(RunningClock, NoFrameChangesAPixelByMoreThanTwoSteps) {
  look_west();
  for (const int begin : {43200, 63900, 64500, 65100}) {  // noon; 17:45, 17:55 and 18:05
    DayClock clock(begin);
    moment_.exposure_ev.reset();
    Bytes last = picture(begin);
    moment_.exposure_ev = view_->adapted_ev({}, 0.0);
    last = picture(begin);
    int steps = 0;
    for (int frame = 0; frame < 60; ++frame) {
      const int before = clock.time_of_day_s();
      clock.turn(kDayRate * kFrameS);
      steps += clock.time_of_day_s() != before ? 1 : 0;
      moment_.exposure_ev = view_->adapted_ev(moment_.exposure_ev, kFrameS);
      Bytes now = picture(clock.time_of_day_s());
      EXPECT_LE(change(last, now, clock.time_of_day_s()), 2) << begin << ", frame " << frame;
      last = std::move(now);
    }
    EXPECT_GE(steps, 20);
  }
}

TEST_F(RunningClock, StepsOfTenSecondsWouldShow) {
  look_west();
  moment_.exposure_ev.reset();
  picture(64500);
  moment_.exposure_ev = view_->adapted_ev({}, 0.0);
  int most = 0;
  for (int time_s = 64200; time_s < 65400; time_s += 120)
    most = std::max(most, change(picture(time_s), picture(time_s + 10), time_s));
  EXPECT_GT(most, 2);
}

}  // namespace
}  // namespace skerry::game
