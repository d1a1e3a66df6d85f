// What the reach of lamps leaves out must be nothing that is seen.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/gpu/device/device.h"
#include "engine/gpu/transfer/readback.h"
#include "game/view/scene_view.h"
#include "tests/gpu/test_device.h"

namespace skerry::game {
namespace {

constexpr VkExtent2D kSize{160, 90};

class LampReachFrames : public gpu::GpuTest {
 protected:
  struct Drawn {
    std::vector<std::byte> picture;
    std::size_t lights = 0;
  };
  Drawn draw(const char* seed, bool oracle, double turn_deg) {
    SceneOptions options;
    options.seed_text = seed;
    options.settings.view_distance = 300;
    options.settings.view_detail = 128;
    options.settings.indirect = render::Indirect::kOff;
    options.settings.shadow_enabled = false;
    options.settings.lights_shadows = render::kEveryLight;
    options.settings.lights_oracle = oracle;
    options.settings.exposure_ev = 3.0;
    Result<std::unique_ptr<SceneView>> made = SceneView::create(device(), options);
    EXPECT_TRUE(made) << made.error().message;
    SceneView& view = **made;
    SceneView::Moment moment;
    moment.camera = view.start_camera();
    moment.camera.yaw_deg += turn_deg;
    moment.time_of_day_s = 0.0;
    EXPECT_TRUE(view.load_completely(moment.camera, moment.world_time_s));
    EXPECT_TRUE(view.draw(moment, kSize));
    view.renderer().finish();
    auto picture = gpu::read_back(device(), view.renderer().picture(), 4);
    EXPECT_TRUE(picture);
    return {*std::move(picture), view.lights()};
  }
};

TEST_F(LampReachFrames, EveryPixelIsThatOfAllLampsAsked) {
  std::size_t lights = 0;
  for (const char* seed : {"1", "3", "7"}) {
    for (const double turn : {0.0, 140.0}) {
      const Drawn clusters = draw(seed, false, turn), oracle = draw(seed, true, turn);
      EXPECT_TRUE(clusters.picture == oracle.picture) << seed << ", turned by " << turn;
      lights += clusters.lights;
    }
  }
  EXPECT_GT(lights, 20u) << "there must be lamps to ask";
}

}  // namespace
}  // namespace skerry::game
