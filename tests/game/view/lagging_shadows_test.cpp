// What it shows in a picture that coarse shadow maps may lag: a flight drawn with and without.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/trigonometric.hpp>

#include "engine/gpu/transfer/readback.h"
#include "game/input/controls.h"
#include "game/view/scene_view.h"
#include "tests/gpu/test_device.h"

namespace skerry::game {
namespace {

constexpr VkExtent2D kSize{320, 180};
constexpr double kFrameS = 1.0 / 30.0, kDayRate = 24.0, kSpeed = 20.0;
using Bytes = std::vector<std::byte>;

class LaggingShadows : public gpu::GpuTest {
 protected:
  LaggingShadows() : GpuTest(gpu::Checks::kAllInLongRuns) {}
  std::unique_ptr<SceneView> view() {
    SceneOptions options;
    options.seed_text = "1";
    options.settings.view_distance = 400;
    options.settings.render.shadow_size = 1024;
    Result<std::unique_ptr<SceneView>> made = SceneView::create(device(), options);
    EXPECT_TRUE(made);
    return made ? *std::move(made) : nullptr;
  }
  Bytes picture(SceneView& view, const SceneView::Moment& moment) {
    EXPECT_TRUE(view.draw(moment, kSize));
    view.renderer().finish();
    Result<Bytes> bytes = gpu::read_back(device(), view.renderer().picture(), 4);
    EXPECT_TRUE(bytes);
    return bytes ? *std::move(bytes) : Bytes{};
  }
};

/// Share of pixels of which a channel differs by more than 8/255.
double differing(const Bytes& a, const Bytes& b) {
  std::size_t count = 0;
  for (std::size_t pixel = 0; pixel + 3 < a.size(); pixel += 4) {
    int most = 0;
    for (std::size_t c = 0; c < 3; ++c)
      most = std::max(
          most, std::abs(std::to_integer<int>(a[pixel + c]) - std::to_integer<int>(b[pixel + c])));
    count += most > 8 ? 1 : 0;
  }
  return 4.0 * static_cast<double>(count) / static_cast<double>(a.size());
}

TEST_F(LaggingShadows, ChangeFewPixelsOfAFlight) {
  const std::unique_ptr<SceneView> lagging = view(), exact = view();
  ASSERT_TRUE(lagging && exact);
  SceneView::Moment moment;
  moment.camera = lagging->start_camera();
  moment.camera.pitch_deg = -20.0;
  moment.camera.position[1] += 20 * 65536;
  DayClock clock(15 * 3600);
  double sum = 0.0, most = 0.0;
  std::uint32_t parts = 0;
  constexpr int kFrames = 90;
  for (int frame = 0; frame < kFrames; ++frame) {
    if (frame % 15 == 0) {
      ASSERT_TRUE(lagging->load_completely(moment));
      ASSERT_TRUE(exact->load_completely(moment));
    }
    moment.may_lag = true;
    const Bytes shown = picture(*lagging, moment);
    const auto& passes = lagging->renderer().report()->passes;
    parts += std::ranges::any_of(
        passes, [](const gpu::PassTime& p) { return p.name == "draw_shadow_ahead"; });
    moment.may_lag = false;
    const double off = differing(shown, picture(*exact, moment));
    sum += off;
    most = std::max(most, off);
    const double yaw = glm::radians(moment.camera.yaw_deg);
    moment.camera.position[0] +=
        static_cast<std::int64_t>(std::sin(yaw) * kSpeed * kFrameS * 65536);
    moment.camera.position[2] +=
        static_cast<std::int64_t>(std::cos(yaw) * kSpeed * kFrameS * 65536);
    moment.world_time_s += kFrameS;
    clock.turn(kDayRate * kFrameS);
    moment.time_of_day_s = clock.time_of_day_s();
  }
  EXPECT_GT(parts, 20u) << "nothing lagged";
  EXPECT_LT(sum / kFrames, 0.002);
  EXPECT_LT(most, 0.015);
}

}  // namespace
}  // namespace skerry::game
