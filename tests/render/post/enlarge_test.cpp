// A picture that is drawn smaller than it is shown. docs/decisions/0035.
#include "engine/render/post/enlarge_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shaders/shared/constants.h"
#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{64, 48};

world::BlockId steps(int x, int y, int z) {
  return y <= (x + z) % 7 / 3 ? world::block::kGrass : world::block::kAirBlock;
}

class Enlarged : public RendererOnGpu {
 protected:
  void SetUp() override {
    RendererOnGpu::SetUp();
    if (!HasFatalFailure()) add(steps, {0, -1, 0}, {1, 0, 1});
  }
  void begin_again() {
    restart();
    add(steps, {0, -1, 0}, {1, 0, 1});
  }
  FrameInput view() const {
    FrameInput in;
    in.islands = islands_;
    in.sky = sun_at(35.0, 60.0);
    in.camera = camera_at({8.0, 6.0, -3.0}, 0.0, -20.0);
    in.exposure_ev = -1.0f;
    return in;
  }
  static RenderSettings scaled(float scale) {
    RenderSettings out;
    out.render_scale = scale;
    return out;
  }
  std::vector<std::uint8_t> shown(const FrameInput& input, const RenderSettings& settings,
                                  VkExtent2D size) {
    drawn(input, settings, size);
    EXPECT_EQ(renderer().picture().desc().extent.width, size.width);
    EXPECT_EQ(renderer().picture().desc().extent.height, size.height);
    return picture();
  }

 private:
  std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
};

/// The four nearest pixels of a small picture, weighed in double precision.
double expected(const std::vector<std::uint8_t>& small, VkExtent2D drawn, VkExtent2D size, int x,
                int y, int channel) {
  const auto place = [](int pixel, std::uint32_t shown, std::uint32_t pixels) {
    const double at = (pixel + 0.5) * pixels / shown - 0.5;
    const double share =
        std::clamp((at - std::floor(at) - 0.5) * double{shared::kEnlargeSlope} + 0.5, 0.0, 1.0);
    return std::pair(static_cast<int>(std::floor(at)), share);
  };
  const auto [left, right_share] = place(x, size.width, drawn.width);
  const auto [top, bottom_share] = place(y, size.height, drawn.height);
  double sum = 0.0;
  for (const int dy : {0, 1})
    for (const int dx : {0, 1}) {
      const int column = std::clamp(left + dx, 0, static_cast<int>(drawn.width) - 1);
      const int row = std::clamp(top + dy, 0, static_cast<int>(drawn.height) - 1);
      const double weight =
          (dx ? right_share : 1.0 - right_share) * (dy ? bottom_share : 1.0 - bottom_share);
      sum += weight * small[(static_cast<std::size_t>(row) * drawn.width + column) * 4 + channel];
    }
  return sum;
}

TEST_F(Enlarged, IsThePictureOfTheSmallerSizeWeighedByPlace) {
  const VkExtent2D odd{61, 47};
  for (const auto& [size, scale] : {std::pair(kSize, 0.5f), std::pair(kSize, 0.25f),
                                    std::pair(odd, 0.7f), std::pair(VkExtent2D{1, 1}, 0.25f)}) {
    const auto edge = [s = scale](std::uint32_t pixels) {
      return static_cast<std::uint32_t>(std::ceil(static_cast<double>(pixels) * s));
    };
    const VkExtent2D small{edge(size.width), edge(size.height)};
    const std::vector<std::uint8_t> got = shown(view(), scaled(scale), size);
    const std::vector<std::uint8_t> from = shown(view(), {}, small);
    int apart = 0;
    for (int y = 0; y < static_cast<int>(size.height); ++y)
      for (int x = 0; x < static_cast<int>(size.width); ++x)
        for (int channel = 0; channel < 4; ++channel) {
          const double truth = expected(from, small, size, x, y, channel);
          const int pixel = got[(static_cast<std::size_t>(y) * size.width + x) * 4 + channel];
          // Filters of a device keep 8 bits of a place between texels.
          if (std::abs(pixel - truth) > 1.6) ++apart;
        }
    EXPECT_EQ(apart, 0) << size.width << "x" << size.height << " at " << scale;
  }
}

TEST_F(Enlarged, WholeSizeAndDebugViewsAreDrawnAsTheyAreShown) {
  drawn(view(), scaled(1.0f), kSize);
  EXPECT_FALSE(has_pass("enlarge_picture"));
  drawn(view(), scaled(0.5f), kSize);
  EXPECT_TRUE(has_pass("enlarge_picture"));
  RenderSettings channel = scaled(0.5f);
  channel.debug_view = DebugView::kNormal;
  const std::vector<std::uint8_t> small = shown(view(), channel, kSize);
  channel.render_scale = 1.0f;
  EXPECT_EQ(small, shown(view(), channel, kSize));
}

// Whatever a frame consists of: over radiance, of several parts, of several samples.
TEST_F(Enlarged, IsMadeOfEveryKindOfFrame) {
  FrameInput metered = view();
  metered.exposure_ev.reset();
  FrameInput parts = view();
  parts.parts = 3;
  RenderSettings half = scaled(0.5f), samples = half;
  samples.aa_samples = 4;
  for (const auto& [input, settings] :
       {std::pair(view(), half), std::pair(metered, half), std::pair(view(), samples)})
    EXPECT_FALSE(shown(input, settings, kSize).empty());
  std::vector<std::uint8_t> last;
  for (parts.part = 0; parts.part < parts.parts; ++parts.part) last = shown(parts, half, kSize);
  const std::vector<std::uint8_t> one = shown(view(), half, kSize);
  int apart = 0;
  for (std::size_t i = 0; i < one.size(); ++i) apart += std::abs(one[i] - last[i]) > 24;
  EXPECT_LT(apart, static_cast<int>(one.size() / 20)) << "parts differ in the sun's place alone";
  // Back to the whole size: nothing of the smaller picture is left.
  begin_again();
  const std::vector<std::uint8_t> whole = shown(view(), {}, kSize);
  shown(view(), half, kSize);
  EXPECT_EQ(shown(view(), {}, kSize), whole);
}

}  // namespace
}  // namespace skerry::render
