// What is left out as hidden must be nothing that is seen: the G-buffer of a frame that leaves it
// out against that of one which draws everything, pixel by pixel.
#include <gtest/gtest.h>

#include <cstring>

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
  OcclusionTest() : GpuTest(gpu::Checks::kAllInLongRuns) {}
  std::unique_ptr<SceneView> view_of(const char* seed, render::Occlusion occlusion) {
    SceneOptions options;
    options.seed_text = seed;
    options.settings.view_distance = 400;
    options.settings.view_detail = 256;
    options.settings.view_error = 0.0;  // far ends that are coarse hide less
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

  /// Turns, walks, cuts and drifts about a place.
  void compare(const char* seed, glm::dvec3 place, double time_s, int frames) {
    const auto all = view_of(seed, render::Occlusion::kOff),
               some = view_of(seed, render::Occlusion::kAlways);
    SceneView::Moment moment;
    moment.capture = true;
    const render::FixedPos start = render::fixed_at(place);
    moment.camera.position = start;
    moment.world_time_s = time_s;
    for (SceneView* view : {all.get(), some.get()}) ASSERT_TRUE(view->load_completely(moment));
    render::RandomPlaces random(frames);
    for (int i = 0; i < frames; ++i) {
      if (i % 8 == 0) {  // a cut, now and then to within rock
        moment.camera.position =
            render::sum(start, render::fixed_at(random.in_box(i % 16 == 0 ? 160.0 : 24.0)));
        moment.camera.yaw_deg = random.uniform(0.0, 360.0);
        moment.camera.pitch_deg = random.uniform(-60.0, 40.0);
        moment.camera.fov_deg = i % 24 == 0 ? random.uniform(0.1, 175.0) : 70.0;
        moment.world_time_s = time_s + random.uniform(0.0, 60.0);
      } else {
        moment.camera.yaw_deg += random.uniform(-40.0, 40.0);
        moment.camera.position = render::sum(
            moment.camera.position, render::fixed_at(random.in_box(i % 8 < 4 ? 0.5 : 8.0)));
        moment.world_time_s += 0.1;
      }
      const Seen expected = seen(*all, moment), got = seen(*some, moment);
      ASSERT_TRUE(got.depths == expected.depths) << "frame " << i;
      equal_depths_ += differing(got.words, expected.words);
      EXPECT_EQ(got.stats.quads_in_view, expected.stats.quads) << "frame " << i;
      drawn_ += got.stats.quads;
      in_view_ += got.stats.quads_in_view;
    }
  }

  static std::size_t differing(const std::vector<std::byte>& a, const std::vector<std::byte>& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); i += 4) count += std::memcmp(&a[i], &b[i], 4) != 0;
    return count;
  }

  std::uint64_t drawn_ = 0, in_view_ = 0;  // quads
  /// Pixels that show another surface at the same depth: of two that are equally far the one that
  /// is drawn first is seen.
  std::size_t equal_depths_ = 0;
};

// A thousand views in long runs.
TEST_F(OcclusionTest, LosesNoPixel) {
  const int views = long_tests() ? 350 : 70;
  compare("1", {-1817.0, 29.0, 696.0}, 39.0, views);  // before an island of 400,000 quads
  compare("1", {-79.9, 1.0, -23.3}, 0.0, views);
  compare("4", {181.3, 30.6, 15.0}, 0.0, views);  // in the mouth of a cave
  EXPECT_LT(static_cast<double>(drawn_), 0.9 * static_cast<double>(in_view_)) << "much is hidden";
  EXPECT_LE(equal_depths_, 10u) << "of two to ten million pixels";
}

}  // namespace
}  // namespace skerry::game
