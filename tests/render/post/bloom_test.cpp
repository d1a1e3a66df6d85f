// Bloom on a real device, judged by the reference's pyramid in double precision and by sums of
// light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/render/post/bloom_pass.h"
#include "engine/render/post/develop_pass.h"
#include "tests/gpu/compile_glsl.h"
#include "tests/render/post_on_gpu.h"
#include "tests/render/renderer_on_gpu.h"
#include "tools/reference/reference.h"

namespace skerry::render {
namespace {

using measure::Picture;

constexpr float kEv = -1.0f;

Picture black(std::uint32_t width, std::uint32_t height) {
  return {width, height, std::vector<glm::vec3>(std::size_t{width} * height, glm::vec3(0.0f))};
}

/// Mostly dim, with bright specks.
Picture specks(std::uint32_t width, std::uint32_t height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> dim(0.0f, 0.5f), bright(0.5f, 40.0f);
  Picture out = black(width, height);
  for (glm::vec3& c : out.pixels) {
    const bool speck = random() % 9 == 0;
    for (int i = 0; i < 3; ++i)
      c[i] = glm::unpackHalf1x16(glm::packHalf1x16(speck ? bright(random) : dim(random)));
  }
  return out;
}

glm::dvec3 sum_of(const Picture& picture) {
  glm::dvec3 sum(0.0);
  for (const glm::vec3& c : picture.pixels) sum += glm::dvec3(c);
  return sum;
}

/// Light over the threshold that a picture gives.
glm::dvec3 taken_from(const Picture& picture, const BloomSettings& settings) {
  glm::dvec3 sum(0.0);
  for (const glm::vec3& c : picture.pixels)
    if (std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z))
      sum += reference::too_bright(glm::dvec3(c) * std::exp2(-double{kEv}), settings.threshold);
  return sum;
}

class BloomOnGpu : public PostOnGpu {
 protected:
  void SetUp() override {
    PostOnGpu::SetUp();
    shaders_.assign(gpu::embedded_shaders().begin(), gpu::embedded_shaders().end());
    shaders_.push_back(show_glow_.embedded());
    own_ = HasFatalFailure() ? nullptr : std::make_unique<gpu::Pipelines>(device(), shaders_);
  }
  void TearDown() override {
    own_.reset();
    PostOnGpu::TearDown();
  }

  /// What develop.comp adds to each exposed pixel.
  /// @param on_cpu the levels are made as on a CPU device, whatever the device is.
  Picture glow(const Picture& picture, const BloomSettings& settings, bool on_cpu = false) {
    gpu::Buffer out = room("glow", picture.pixels.size() * sizeof(glm::vec3));
    shared::Exposure given{};
    given.ev = kEv;
    run(picture, given, [&](SceneRefs& scene, gpu::ImageRef radiance) {
      scene.on_cpu = on_cpu;
      const Bloom bloom = BloomPass::add(graph(), pipelines(), scene, radiance, settings);
      gpu::BufferRef to = graph().import(out);
      graph().add_pass(
          "show_glow",
          [&](gpu::PassBuilder& b) {
            b.read(bloom.glow, gpu::Use::kComputeRead);
            to = b.write(to, gpu::Use::kComputeWrite);
          },
          [this, bloom, to, size = scene.size](gpu::Commands& c) {
            c.bind(own_->get(gpu::ComputeDesc{"show_glow.comp", {}}));
            c.storage(0, bloom.glow);
            c.storage(1, to);
            c.push(bloom.step);
            c.dispatch(gpu::Commands::groups(size.width, 8), gpu::Commands::groups(size.height, 8),
                       1);
          });
    });
    return {picture.width, picture.height, contents<glm::vec3>(out)};
  }

 private:
  gpu::TestShader show_glow_{"show_glow.comp",
                             "#include \"shared/bloom.h\"\n"
                             R"(
    layout(local_size_x = 8, local_size_y = 8) in;
    layout(binding = 0, rgba16f) readonly uniform image2D coarse;
    layout(scalar, binding = 1) writeonly buffer To { vec3 glow[]; };
    layout(push_constant) uniform Push { BloomStep step; } push;
    uvec2 coarse_size() { return push.step.coarse_size; }
)"
                             "const int kTileTexels = 128;\n#include \"include/post/bloom.glsl\"\n"
                             R"(
    void main() {
      vec3 added = push.step.intensity * spread_from_coarser();
      uvec2 at = gl_GlobalInvocationID.xy;
      if (any(greaterThanEqual(at, push.step.fine_size))) return;
      glow[at.y * push.step.fine_size.x + at.x] = added;
    })"};
  std::vector<gpu::EmbeddedShader> shaders_;
  std::unique_ptr<gpu::Pipelines> own_;
};

constexpr BloomSettings kSettings{0.2f, 1.5f, 6};

TEST_F(BloomOnGpu, IsThePyramidInDoublePrecisionAtAnySize) {
  for (const auto& [width, height] : std::vector<std::pair<std::uint32_t, std::uint32_t>>{
           {1, 1}, {2, 1}, {1, 9}, {3, 3}, {17, 31}, {64, 64}, {150, 77}}) {
    for (const int levels : {1, 3, 8}) {
      const BloomSettings settings{0.2f, 1.5f, levels};
      const Picture picture = specks(width, height, width * 100 + height);
      const Picture got = glow(picture, settings),
                    expected = reference::glow(picture, kEv, settings);
      double most = 0.0;
      for (const glm::vec3& c : expected.pixels)
        most = std::max(most, double{glm::max(c.x, glm::max(c.y, c.z))});
      for (std::size_t i = 0; i < got.pixels.size(); ++i)
        // Each level is rounded to half precision, towards zero at worst: 2^-10 a step, twice.
        EXPECT_LE(glm::length(got.pixels[i] - expected.pixels[i]),
                  glm::length(expected.pixels[i]) * 2.0 * (levels + 1) / 1024.0 + 1e-6)
            << width << "x" << height << ", " << levels << " levels, pixel " << i;
      EXPECT_GT(most, 0.0);
    }
  }
}

/// Black but for a few pixels that are far too bright.
Picture a_few_lit(std::uint32_t width, std::uint32_t height, unsigned seed) {
  std::mt19937 random(seed);
  Picture out = black(width, height);
  for (unsigned i = 0; i < 5; ++i)
    out.pixels[random() % out.pixels.size()] = glm::vec3(30.0f, 10.0f, 0.25f);
  return out;
}

// Sums run in the same order, and tiles that are left out are black.
TEST_F(BloomOnGpu, ByColumnsOfListedTilesIsTheSameToTheBit) {
  for (const auto& [width, height] : std::vector<std::pair<std::uint32_t, std::uint32_t>>{
           {1, 1}, {9, 1}, {1, 70}, {17, 31}, {64, 64}, {150, 77}, {300, 131}}) {
    for (const int levels : {1, 2, 8}) {
      for (unsigned seed = 0; seed < 6; ++seed) {
        const BloomSettings settings{0.2f, 1.5f, levels};
        const Picture picture =
            seed < 2 ? specks(width, height, seed) : a_few_lit(width, height, seed);
        EXPECT_EQ(glow(picture, settings, true).pixels, glow(picture, settings).pixels)
            << width << "x" << height << ", " << levels << " levels, picture " << seed;
      }
    }
  }
}

// Each place of a tile's edges, where a neighbour looks at it or does not.
TEST_F(BloomOnGpu, ByColumnsMissesNoPixelThatATileLooksAt) {
  for (std::uint32_t at = 12; at < 36; ++at) {
    Picture picture = black(48, 48);
    picture.pixels[at * 48 + (47 - at)] = glm::vec3(4.0f);
    EXPECT_EQ(glow(picture, kSettings, true).pixels, glow(picture, kSettings).pixels) << at;
  }
}

TEST_F(BloomOnGpu, AddsNoMoreLightThanWasTaken) {
  for (const auto& [width, height] :
       std::vector<std::pair<std::uint32_t, std::uint32_t>>{{1, 1}, {7, 5}, {33, 64}, {129, 70}}) {
    for (unsigned seed = 0; seed < 4; ++seed) {
      const Picture picture = specks(width, height, seed);
      const glm::dvec3 added = sum_of(glow(picture, kSettings)),
                       taken = taken_from(picture, kSettings) * double{kSettings.intensity};
      for (int i = 0; i < 3; ++i) EXPECT_LE(added[i], taken[i] * (1.0 + 1e-5)) << width << seed;
    }
  }
}

// Away from the edges nothing is lost but what the calmed first step holds back from specks; of an
// even patch it holds back nothing inside.
TEST_F(BloomOnGpu, OfAnEvenPatchKeepsNearlyAllLight) {
  Picture picture = black(512, 512);
  for (std::uint32_t y = 240; y < 272; ++y)
    for (std::uint32_t x = 240; x < 272; ++x) picture.pixels[y * 512 + x] = glm::vec3(2.0f);
  const BloomSettings settings{0.2f, 1.5f, 4};
  const glm::dvec3 added = sum_of(glow(picture, settings)),
                   taken = taken_from(picture, settings) * 0.2;
  EXPECT_GT(added.x, 0.85 * taken.x);
}

TEST_F(BloomOnGpu, TakesNothingBelowTheKnee) {
  Picture picture = black(40, 30);
  // Exposed to just under half the threshold.
  for (glm::vec3& c : picture.pixels) c = glm::vec3(0.74f * std::exp2(kEv), 0.1f, 0.2f);
  for (const glm::vec3& c : glow(picture, kSettings).pixels) EXPECT_EQ(c, glm::vec3(0.0f));
}

// Nothing of what is mirrored or clamped at a border glows back into the picture.
TEST_F(BloomOnGpu, ABrightEdgeGlowsLessThanABrightMiddle) {
  const auto most = [&](std::uint32_t from) {
    Picture picture = black(96, 64);
    for (std::uint32_t y = 0; y < 64; ++y)
      for (std::uint32_t x = from; x < from + 4; ++x) picture.pixels[y * 96 + x] = glm::vec3(5.0f);
    double brightest = 0.0;
    for (const glm::vec3& c : glow(picture, kSettings).pixels)
      brightest = std::max(brightest, double{c.x});
    return brightest;
  };
  const double middle = most(46);
  EXPECT_LT(most(0), middle);
  EXPECT_LT(most(92), middle);
}

// Two texels beyond its pair in shrinking, and two coarser ones in spreading.
TEST_F(BloomOnGpu, OneLevelReachesSevenPixels) {
  Picture picture = black(64, 48);
  picture.pixels[24 * 64 + 31] = glm::vec3(30.0f);
  const Picture got = glow(picture, {1.0f, 1.5f, 1});
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      const int far = std::max(std::abs(x - 31), std::abs(y - 24));
      const float seen = got.pixels[static_cast<std::size_t>(y) * 64 + x].x;
      EXPECT_TRUE(far <= 7 || seen == 0.0f) << x << ", " << y;
      EXPECT_TRUE(far > 1 || seen > 0.0f) << x << ", " << y;
    }
}

TEST_F(BloomOnGpu, WhatIsNoNumberGivesNothing) {
  const Picture clean = black(40, 40);
  for (const float broken : {NAN, INFINITY, -INFINITY}) {
    Picture picture = clean;
    picture.pixels[820] = glm::vec3(broken);
    for (const glm::vec3& c : glow(picture, kSettings).pixels) EXPECT_EQ(c, glm::vec3(0.0f));
  }
}

TEST(BloomLevels, EndAtASingleTexel) {
  EXPECT_EQ(bloom_levels({1, 1}, 6), 1u);
  EXPECT_EQ(bloom_levels({2, 2}, 6), 1u);
  EXPECT_EQ(bloom_levels({3, 1}, 6), 2u);
  EXPECT_EQ(bloom_levels({64, 9}, 8), 6u);
  EXPECT_EQ(bloom_levels({1280, 720}, 6), 6u);
}

class FrameWithBloom : public RendererOnGpu {};

TEST_F(FrameWithBloom, HasNoneOfItsPassesAtNoIntensityAndOfManySizes) {
  FrameInput input;
  input.sky = sun_at(10.0, 0.0);
  RenderSettings settings;
  (void)drawn(input, settings, {64, 48});
  EXPECT_FALSE(has_pass("bloom"));
  EXPECT_FALSE(has_pass("develop"));
  settings.bloom.intensity = 0.1f;
  for (const VkExtent2D size : {VkExtent2D{64, 48}, {1, 1}, {37, 3}, {5, 61}}) {
    EXPECT_EQ(drawn(input, settings, size).pixels.non_finite, 0u);
    EXPECT_TRUE(has_pass("shrink_bloom_1"));
  }
}

TEST_F(FrameWithBloom, GlowsAboutTheSunAndLeavesADimPictureAsItIs) {
  FrameInput input;
  input.sky = sun_at(20.0, 0.0);
  input.camera = camera_at({0.0, 0.0, 0.0}, 0.0, 20.0);
  RenderSettings settings;
  settings.meter.max_ev = 4.0f;
  input.capture = true;
  (void)drawn(input, settings, {128, 96});
  const std::vector<std::uint8_t> plain = picture();
  settings.bloom.intensity = 0.1f;
  (void)drawn(input, settings, {128, 96});
  const std::vector<std::uint8_t> glowing = picture();
  std::size_t brighter = 0, darker = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    brighter += glowing[i] > plain[i];
    darker += glowing[i] < plain[i];
  }
  EXPECT_GT(brighter, 500u);
  EXPECT_EQ(darker, 0u);
  input.exposure_ev = 8.0f;  // nothing is bright now but the disc
  input.sky = sun_at(60.0, 180.0);
  settings.bloom.intensity = 0.0f;
  (void)drawn(input, settings, {128, 96});
  const std::vector<std::uint8_t> dim = picture();
  settings.bloom.intensity = 0.1f;
  (void)drawn(input, settings, {128, 96});
  EXPECT_EQ(picture(), dim);
}

}  // namespace
}  // namespace skerry::render
