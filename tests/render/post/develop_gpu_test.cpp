// From radiance to the picture: the renderer's against the reference's double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "tests/render/renderer_on_gpu.h"
#include "tools/reference/reference.h"

namespace skerry::render {
namespace {

class Development : public RendererOnGpu {
 protected:
  /// Of the last frame, drawn with capture.
  measure::Picture radiance() {
    const Captured copied = renderer().captured(Capture::kRadiance);
    measure::Picture out{copied.size.width, copied.size.height, {}};
    for (std::size_t at = 0; at < copied.texels.size(); at += 8) {
      std::uint64_t halves;
      std::memcpy(&halves, copied.texels.data() + at, sizeof(halves));
      out.pixels.emplace_back(glm::unpackHalf4x16(halves));
    }
    return out;
  }
};

TEST_F(Development, IsTheReferencesToWithinARoundingAndTheDither) {
  FrameInput input;
  input.sky = sun_at(18.0, 0.0);
  input.camera = camera_at({0.0, 0.0, 0.0}, 0.0, 10.0);
  input.capture = true;
  for (const ToneCurve tone : {ToneCurve::kAces, ToneCurve::kAgx}) {
    for (const DisplaySettings& display : {DisplaySettings{}, DisplaySettings{0.6f, 0.03f}}) {
      for (const float intensity : {0.0f, 0.2f}) {
        for (const float ev : {-4.0f, -0.5f, 6.0f}) {
          RenderSettings settings;
          settings.tone = tone;
          settings.display = display;
          settings.bloom.intensity = intensity;
          input.exposure_ev = ev;
          (void)drawn(input, settings, {120, 90});
          const std::vector<std::uint8_t> got = picture(),
                                          expected = reference::develop(
                                              radiance(), ev, {tone, display, settings.bloom});
          ASSERT_EQ(got.size(), expected.size());
          int worst = 0;
          for (std::size_t i = 0; i < got.size(); ++i)
            worst = std::max(worst, std::abs(int{got[i]} - int{expected[i]}));
          // Half a code of dither, and two roundings that may fall to either side.
          EXPECT_LE(worst, intensity > 0.0f ? 2 : 1)
              << "tone " << int(tone) << ", peak " << display.peak << ", bloom " << intensity
              << ", " << ev << " stops";
        }
      }
    }
  }
}

TEST_F(Development, BlackIsBlackOnEveryDisplayByEveryCurve) {
  FrameInput input;
  input.sky = celestial_at(0.0, 0.0);
  input.exposure_ev = -20.0f;
  for (const ToneCurve tone : {ToneCurve::kAces, ToneCurve::kAgx}) {
    RenderSettings settings;
    settings.tone = tone;
    settings.display = {1.0f, 0.2f};
    settings.bloom.intensity = 1.0f;
    settings.leave_out.add(Feature::kStars);
    add(
        [](int x, int y, int z) -> world::BlockId {
          const int least = std::min({x, y, z}), most = std::max({x, y, z});
          if (least < 10 || most >= 40) return world::block::kAirBlock;
          return least < 12 || most >= 38 ? world::block::kStone : world::block::kAirBlock;
        },
        {0, 0, 0}, {1, 1, 1});
    const std::vector<IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
    input.islands = islands;
    input.camera = camera_at({25.0, 20.0, 25.0}, 30.0, 0.0);
    (void)drawn(input, settings, {64, 48});
    const std::vector<std::uint8_t> seen = picture();
    for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_TRUE(i % 4 == 3 || seen[i] == 0) << i;
    restart();
  }
}

TEST_F(Development, TheMetersViewIsDrawnOverThePictureAndOverNothingElse) {
  FrameInput input;
  input.sky = sun_at(40.0, 0.0);
  input.capture = true;
  RenderSettings settings;
  (void)drawn(input, settings, {160, 90});
  const std::vector<std::uint8_t> plain = picture();
  settings.debug_view = DebugView::kExposure;
  const FrameReport report = drawn(input, settings, {160, 90});
  EXPECT_TRUE(report.metered_ev.has_value());
  const std::vector<std::uint8_t> shown = picture();
  int changed = 0;
  for (std::size_t i = 0; i < plain.size(); i += 4) {
    const bool same = std::equal(&plain[i], &plain[i] + 4, &shown[i]);
    EXPECT_TRUE(same || i / 4 >= 160u * 60u) << i;
    changed += !same;
  }
  EXPECT_GT(changed, 160 * 20);
  (void)drawn(input, settings, {1, 1});
  (void)drawn(input, settings, {3, 2});
}

}  // namespace
}  // namespace skerry::render
