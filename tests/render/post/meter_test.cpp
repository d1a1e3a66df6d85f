// The light meter on a real device, judged by counting and sorting on the CPU.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/render/post/meter_pass.h"
#include "tests/render/post_on_gpu.h"
#include "tests/render/renderer_on_gpu.h"
#include "tools/reference/reference.h"

namespace skerry::render {
namespace {

using measure::Picture;

glm::vec3 halved(glm::vec3 c) {
  return glm::vec3(glm::unpackHalf4x16(glm::packHalf4x16(glm::vec4(c, 0.0f))));
}

/// Luminances over all that half precision holds, some of it black.
Picture random_picture(std::uint32_t width, std::uint32_t height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> stops(-24.0f, 15.9f), tint(0.2f, 1.0f);
  Picture out{width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    const float light = random() % 7 == 0 ? 0.0f : std::exp2(stops(random));
    out.pixels.push_back(
        halved({light * tint(random), light * tint(random), light * tint(random)}));
  }
  return out;
}

/// A landscape's spread of light: normal in stops, half of it in a brighter sky.
Picture landscape(std::uint32_t width, std::uint32_t height, double mean_stops) {
  std::mt19937 random(7);
  std::normal_distribution<double> stops(mean_stops, 1.5);
  Picture out{width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i)
    out.pixels.push_back(halved(glm::vec3(
        static_cast<float>(std::exp2(stops(random) + (2 * i < width * height ? 2 : 0))))));
  return out;
}

/// Number of the bin whose light, by docs/exposure.md, a pixel has: an eighth of its power of two.
std::size_t expected_bin(glm::vec3 c) {
  const float sum = 0.2126f * c.x + 0.7152f * c.y, y = sum + 0.0722f * c.z;
  int exponent = 0;
  const double mantissa = std::frexp(double{y}, &exponent) * 2.0;  // 1 .. 2
  const int bin = (exponent - 1 + 16) * 8 + static_cast<int>((mantissa - 1.0) * 8.0);
  return static_cast<std::size_t>(std::clamp(bin, 0, 255));
}

class Meter : public PostOnGpu {
 protected:
  std::vector<std::uint32_t> histogram(const Picture& picture, const MeterSettings& settings = {},
                                       bool decides = true) {
    gpu::Buffer counts = room("counts", shared::kHistogramBins * 4);
    run(picture, {kGiven, 0.0f, 0, 0, 0, 0}, [&](SceneRefs& scene, gpu::ImageRef radiance) {
      keep(MeterPass::add(graph(), pipelines(), scene, {radiance, {}}, settings, decides).histogram,
           counts);
    });
    return contents<std::uint32_t>(counts);
  }
  static constexpr float kGiven = -3.5f;
};

TEST_F(Meter, TheHistogramCountsEveryPixelThatIsNotBlack) {
  for (const auto& [width, height] : std::vector<std::pair<std::uint32_t, std::uint32_t>>{
           {1, 1}, {1, 37}, {53, 1}, {31, 17}, {257, 130}}) {
    const Picture picture = random_picture(width, height, width * 1000 + height);
    MeterSettings every;
    every.stride = 1;
    std::vector<std::uint32_t> expected(shared::kHistogramBins);
    std::uint32_t lit = 0;
    for (const glm::vec3& c : picture.pixels) {
      if (0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z < std::ldexp(1.0f, -16)) continue;
      ++expected[expected_bin(c)];
      ++lit;
    }
    EXPECT_EQ(histogram(picture, every), expected) << width << "x" << height;
    EXPECT_EQ(exposure().metered, lit);
  }
}

TEST_F(Meter, ASubsetLooksAtOnePixelOfEachCell) {
  for (const int stride : {2, 4, 7, 16}) {
    // Every pixel lit, each cell with a light of its own bin: a cell looked at twice, or not at
    // all, would show.
    Picture cells{130, 70, {}};
    for (std::uint32_t i = 0; i < 130 * 70; ++i) {
      const auto s = static_cast<std::uint32_t>(stride);
      const std::uint32_t cell = (i / 130 / s * 13 + i % 130 / s * 7) % 200 + 20;
      cells.pixels.push_back(halved(glm::vec3(std::ldexp(
          1.0f + (static_cast<float>(cell % 8) + 0.5f) / 8.0f, static_cast<int>(cell / 8) - 16))));
    }
    std::vector<std::uint32_t> expected(shared::kHistogramBins);
    for (int y = 0; y < 70; y += stride)
      for (int x = 0; x < 130; x += stride)
        ++expected[expected_bin(cells.pixels[static_cast<std::size_t>(y * 130 + x)])];
    MeterSettings settings;
    settings.stride = stride;
    EXPECT_EQ(histogram(cells, settings), expected) << stride;
  }
}

TEST_F(Meter, AgreesWithSortedLuminancesToWithinABin) {
  MeterSettings every{0.35f, -30.0f, 30.0f, 1};
  double worst = 0.0;
  for (double stops = -12.0; stops < 6.0; stops += 1.7) {
    const Picture picture = landscape(128, 96, stops);
    (void)histogram(picture, every);
    const double exact = reference::metered_ev(picture, every).value();
    worst = std::max(worst, std::abs(exposure().metered_ev - exact));
  }
  // A pixel is taken for its bin's middle, at most log2(1.0625) stops off; the mean of many is
  // nearer, and the eye follows 0.7 of it.
  EXPECT_LT(worst, 0.7 * std::log2(1.0625));
  EXPECT_LT(worst, 0.01);
}

TEST_F(Meter, ASubsetIsAsGoodAsTheMeanOfItsPixels) {
  const Picture picture = landscape(640, 360, -4.0);
  const double exact = reference::metered_ev(picture, {}).value();
  for (const int stride : {2, 4, 8}) {
    MeterSettings settings;
    settings.stride = stride;
    (void)histogram(picture, settings);
    // Stops are spread by sqrt(1.5^2 + 1): four standard errors of a mean, and the bins.
    const double looked_at = 640.0 * 360.0 / (stride * stride);
    EXPECT_NEAR(exposure().metered_ev, exact, 0.7 * 4.0 * std::sqrt(3.25 / looked_at) + 0.01)
        << stride;
  }
}

TEST_F(Meter, BlackAsksForNothingAndKeepsTheExposure) {
  (void)histogram({40, 30, std::vector<glm::vec3>(1200, glm::vec3(0.0f))});
  EXPECT_EQ(exposure().metered, 0u);
  EXPECT_EQ(exposure().ev, kGiven);
  // As little as no exposure shows: it must not outvote a lamp.
  (void)histogram({40, 30, std::vector<glm::vec3>(1200, glm::vec3(std::ldexp(0.99f, -16)))});
  EXPECT_EQ(exposure().metered, 0u);
}

TEST_F(Meter, OneLitPixelAmongBlackOnesIsMetered) {
  Picture picture{40, 30, std::vector<glm::vec3>(1200, glm::vec3(0.0f))};
  picture.pixels[777] = glm::vec3(0.25f);
  MeterSettings every;
  every.stride = 1;
  (void)histogram(picture, every);
  EXPECT_EQ(exposure().metered, 1u);
  EXPECT_NEAR(exposure().ev, std::log2(0.25 / 0.35), 0.7 * std::log2(1.0625) + 1e-5);
}

TEST_F(Meter, StaysWithinItsLimits) {
  const MeterSettings limits{0.35f, -2.0f, 1.0f, 4};
  (void)histogram(landscape(64, 64, -14.0), limits);
  EXPECT_EQ(exposure().ev, -2.0f);
  (void)histogram(landscape(64, 64, 9.0), limits);
  EXPECT_EQ(exposure().ev, 1.0f);
}

TEST_F(Meter, ReportsWithoutDecidingWhenTheExposureIsGiven) {
  (void)histogram(landscape(64, 64, -2.0), {}, false);
  EXPECT_EQ(exposure().ev, kGiven);
  EXPECT_GT(exposure().metered, 0u);
  EXPECT_GT(exposure().metered_ev, -2.0f);
}

// A few pixels that are no numbers must not move what all others say.
TEST_F(Meter, IsNotMovedByPixelsThatAreNoNumbers) {
  Picture picture = landscape(128, 64, -3.0);
  MeterSettings every;
  every.stride = 1;
  (void)histogram(picture, every);
  const float clean = exposure().metered_ev;
  for (const float broken : {NAN, INFINITY, -INFINITY}) {
    picture.pixels[500] = glm::vec3(broken);
    (void)histogram(picture, every);
    EXPECT_NEAR(exposure().metered_ev, clean, 0.01) << broken;
  }
}

// Twice the light: 0.7 stops of exposure, so 0.3 stops more of picture.
TEST_F(Meter, TheEyeFollowsSevenTenthsOfAStop) {
  const MeterSettings wide{0.35f, -30.0f, 30.0f, 1};
  (void)histogram(landscape(64, 64, -3.0), wide);
  const float dim = exposure().ev;
  (void)histogram(landscape(64, 64, 1.0), wide);
  EXPECT_NEAR(exposure().ev - dim, 0.7 * 4.0, 0.02);
}

class MeteredFrame : public RendererOnGpu {};

TEST_F(MeteredFrame, IsLeftOutWhenTheExposureIsGivenAndTheWayOverRadianceWithIt) {
  FrameInput input;
  input.sky = sun_at(50.0, 30.0);
  (void)drawn(input, {}, {64, 48});
  for (const char* pass : {"meter", "exposure", "histogram", "develop"})
    EXPECT_FALSE(has_pass(pass)) << pass;
  input.exposure_ev.reset();
  const FrameReport metered = drawn(input, {}, {64, 48});
  EXPECT_TRUE(has_pass("meter_radiance") && has_pass("choose_exposure") && has_pass("develop"));
  ASSERT_TRUE(metered.metered_ev.has_value());
  EXPECT_EQ(metered.exposure_ev, *metered.metered_ev);
}

TEST_F(MeteredFrame, GivenTheExposureItMeteredItIsTheSamePicture) {
  FrameInput input;
  input.sky = sun_at(50.0, 30.0);
  input.capture = true;  // both by way of radiance
  input.exposure_ev.reset();
  const FrameReport metered = drawn(input, {}, {64, 48});
  const std::vector<std::uint8_t> first = picture();
  input.exposure_ev = metered.exposure_ev;
  const FrameReport given = drawn(input, {}, {64, 48});
  EXPECT_EQ(picture(), first);
  EXPECT_FALSE(given.metered_ev.has_value());
  EXPECT_EQ(given.exposure_ev, metered.exposure_ev);
}

TEST_F(MeteredFrame, AGivenExposureDoesNotFeedBackIntoWhatIsMetered) {
  FrameInput input;
  input.sky = sun_at(50.0, 30.0);
  input.meter = true;
  std::optional<float> found;
  for (const float ev : {-20.0f, -1.0f, 0.0f, 20.0f}) {
    input.exposure_ev = ev;
    const FrameReport report = drawn(input, {}, {64, 48});
    EXPECT_EQ(report.exposure_ev, ev);
    ASSERT_TRUE(report.metered_ev.has_value());
    if (!found) found = report.metered_ev;
    EXPECT_EQ(*report.metered_ev, *found);
  }
}

TEST_F(MeteredFrame, ADarkRoomMetersNothingAndIsBlack) {
  add(
      [](int x, int y, int z) -> world::BlockId {
        const int least = std::min({x, y, z}), most = std::max({x, y, z});
        if (least < 10 || most >= 40) return world::block::kAirBlock;
        return least < 12 || most >= 38 ? world::block::kStone : world::block::kAirBlock;
      },
      {0, 0, 0}, {1, 1, 1});
  const std::vector<IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  FrameInput input;
  input.islands = islands;
  input.sky = sun_at(50.0, 30.0);
  input.camera = camera_at({25.0, 20.0, 25.0}, 30.0, 0.0);
  input.exposure_ev.reset();
  const FrameReport report = drawn(input, {}, {64, 48});
  EXPECT_FALSE(report.metered_ev.has_value());
  EXPECT_EQ(report.pixels.black, 64u * 48u);
  for (const std::uint8_t value : picture()) EXPECT_TRUE(value == 0 || value == 255);  // alpha
}

}  // namespace
}  // namespace skerry::render
