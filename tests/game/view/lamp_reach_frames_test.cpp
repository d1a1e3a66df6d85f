// What the reach of lamps leaves out must be nothing that is seen.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "engine/gpu/device/device.h"
#include "engine/gpu/transfer/readback.h"
#include "game/view/scene_view.h"
#include "tests/gpu/test_device.h"

namespace skerry::game {
namespace {

constexpr VkExtent2D kSize{160, 90};

class LampReachFrames : public gpu::GpuTest {
 protected:
  LampReachFrames() : GpuTest(gpu::Checks::kAllInLongRuns) {}
  struct Drawn {
    std::vector<std::byte> picture;
    std::size_t lights = 0;
  };
  struct Asked {
    bool oracle = false;
    std::uint32_t shadows = render::kEveryLight;
    std::uint32_t tile = 16;
    std::optional<render::FixedPos> eye{};  ///< none: where the seed starts
    std::uint32_t random = 0;               ///< lamps about it, of all kinds
  };
  Drawn draw(const char* seed, const Asked& asked, double turn_deg) {
    SceneOptions options;
    options.seed_text = seed;
    options.settings.view_distance = 300;
    options.settings.view_detail = 128;
    options.settings.render.indirect = render::Indirect::kOff;
    options.settings.render.shadow_enabled = false;
    options.settings.render.lights_shadows = asked.shadows;
    options.settings.render.lights_tile = asked.tile;
    options.settings.render.lights_oracle = asked.oracle;
    options.settings.exposure_ev = 3.0;
    options.settings.lights_random = asked.random;
    Result<std::unique_ptr<SceneView>> made = SceneView::create(device(), options);
    EXPECT_TRUE(made) << made.error().message;
    SceneView& view = **made;
    SceneView::Moment moment;
    moment.camera = view.start_camera();
    if (asked.eye) moment.camera.position = *asked.eye;
    moment.camera.yaw_deg += turn_deg;
    moment.time_of_day_s = 0.0;
    EXPECT_TRUE(view.load_completely(moment));
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
      const Drawn clusters = draw(seed, {}, turn), oracle = draw(seed, {.oracle = true}, turn);
      EXPECT_TRUE(clusters.picture == oracle.picture) << seed << ", turned by " << turn;
      lights += clusters.lights;
    }
  }
  EXPECT_GT(lights, 20u) << "there must be lamps to ask";
}

// Tiles find lamps that they need not ask, and such as nothing stands before (cull_shafts.comp).
TEST_F(LampReachFrames, ACaveOfLampsOfAllKindsIsThatOfAllLampsAsked) {
  const auto fixed = [](double blocks) { return static_cast<std::int64_t>(blocks * 65536.0); };
  Asked asked{.eye = {{fixed(181.29), fixed(30.64), fixed(14.98)}}, .random = 60};
  Asked all = asked;
  all.oracle = true;
  for (const double turn : {15.0, 120.0, 250.0}) {
    const Drawn clusters = draw("4", asked, turn), oracle = draw("4", all, turn);
    EXPECT_TRUE(clusters.picture == oracle.picture) << turn;
    EXPECT_GT(clusters.lights, 60u);
  }
}

// Lamps behind walls would dim those before them in the tiles that list them, and not in others.
TEST_F(LampReachFrames, TheNearestLampsDoNotDependOnTiles) {
  for (const char* seed : {"1", "7"}) {
    const Drawn fine = draw(seed, {.shadows = 2, .tile = 8}, 0.0),
                coarse = draw(seed, {.shadows = 2, .tile = 64}, 0.0);
    EXPECT_TRUE(fine.picture == coarse.picture) << seed;
  }
}

}  // namespace
}  // namespace skerry::game
