// What is left out as hidden must be nothing that is seen: the G-buffer of a frame that leaves it
// out against that of one which draws everything, pixel by pixel.
#include <gtest/gtest.h>

#include <cstring>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include "game/view/scene_view.h"
#include "tests/gpu/test_device.h"
#include "tests/render/random_scenes.h"

namespace skerry::game {
namespace {

constexpr VkExtent2D kSize{120, 80};

/// What the camera sees, and how much was drawn for it.
struct Seen {
  std::vector<std::byte> words, depths;
  shared::CullStats stats{};
};

class OcclusionTest : public gpu::GpuTest {
 protected:
  std::unique_ptr<SceneView> view_of(const char* seed, render::Occlusion occlusion) {
    SceneOptions options;
    options.seed_text = seed;
    options.settings.view_distance = 400;
    options.settings.view_detail = 256;
    options.settings.exposure_ev = 0.0;
    render::RenderSettings& settings = options.settings.render;
    settings.indirect = render::Indirect::kOff;
    settings.shadow_enabled = false;
    settings.shading = render::Shading::kFlat;
    settings.ao_strength = 0.0f;
    settings.occlusion = occlusion;
    settings.leave_out.add(render::Feature::kLights);
    Result<std::unique_ptr<SceneView>> made = SceneView::create(device(), options);
    EXPECT_TRUE(made) << made.error().message;
    return *std::move(made);
  }

  static Seen seen(SceneView& view, const SceneView::Moment& moment) {
    EXPECT_TRUE(view.draw(moment, kSize));
    view.renderer().finish();
    return {view.renderer().captured(render::Capture::kSurfaces).texels,
            view.renderer().captured(render::Capture::kDepth).texels,
            view.renderer().report()->camera};
  }

  /// Turns, walks, cuts and drifts about where the seed begins.
  void compare(const char* seed, int frames) {
    const auto all = view_of(seed, render::Occlusion::kOff),
               some = view_of(seed, render::Occlusion::kAlways);
    SceneView::Moment moment;
    moment.camera = all->start_camera();
    moment.capture = true;
    const render::FixedPos start = moment.camera.position;
    for (SceneView* view : {all.get(), some.get()})
      ASSERT_TRUE(view->load_completely(moment.camera, moment.world_time_s));
    render::RandomPlaces random(frames);
    std::uint64_t drawn = 0, in_view = 0;
    for (int i = 0; i < frames; ++i) {
      if (i % 8 == 0) {  // a cut, now and then to within rock
        moment.camera = all->start_camera();
        moment.camera.position =
            render::sum(start, render::fixed_at(random.in_box(i % 16 == 0 ? 160.0 : 24.0)));
        moment.camera.yaw_deg = random.uniform(0.0, 360.0);
        moment.camera.pitch_deg = random.uniform(-60.0, 40.0);
        moment.camera.fov_deg = i % 24 == 0 ? random.uniform(2.0, 120.0) : 70.0;
        moment.world_time_s = random.uniform(0.0, 600.0);
      } else {
        moment.camera.yaw_deg += random.uniform(-40.0, 40.0);
        moment.camera.position = render::sum(
            moment.camera.position, render::fixed_at(random.in_box(i % 8 < 4 ? 0.5 : 8.0)));
        moment.world_time_s += 0.1;
      }
      const Seen expected = seen(*all, moment), got = seen(*some, moment);
      ASSERT_EQ(got.depths, expected.depths) << "frame " << i;
      ASSERT_EQ(got.words, expected.words) << "frame " << i;
      EXPECT_EQ(got.stats.quads_in_view, expected.stats.quads) << "frame " << i;
      drawn += got.stats.quads;
      in_view += got.stats.quads_in_view;
    }
    EXPECT_LT(drawn, in_view) << "something is hidden";
    RecordProperty("drawn_percent", static_cast<int>(100 * drawn / in_view));
  }
};

TEST_F(OcclusionTest, LosesNoPixelOfAThousandViews) {
  for (const char* seed : {"1", "4"}) compare(seed, 500);
}

}  // namespace
}  // namespace skerry::game
