#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "game/scene_file/setting_keys.h"
#include "tests/reference/made_scenes.h"
#include "tools/reference/sampler.h"
#include "tools/reference/textures.h"

namespace skerry::reference {
namespace {

/// Textures, plants, penumbrae and haze in one small picture.
Scene busy_scene() {
  const Island blocks{world::Volume::from_voxels({-20, -1, -20}, {20, 4, 20}, [](world::IVec3 v) {
    const unsigned h = static_cast<unsigned>(v.x * 73 + v.z * 151 + v.y * 31) % 97;
    if (v.y < 0) return world::BlockId{world::block::kGrass};
    if (h < 6) return world::BlockId{world::block::kStone};
    if (h < 12) return world::BlockId{world::block::kOakLeaves};
    return world::BlockId{h < 20 && v.y == 0 ? world::block::kFern : world::block::kAirBlock};
  })};
  Scene scene = seen_from({0.3, 6.2, -9.0}, {0.1, -0.4, 1.0}, {blocks}, 40, 0.6);
  scene.albedo.reset();
  scene.environment = glm::dvec3(0.1, 0.2, 0.3);
  scene.bodies = {{glm::normalize(glm::dvec3(0.5, 0.8, -0.3)), glm::dvec3(3.0), 0.02}};
  scene.haze_per_block = 0.01;
  return scene;
}

TEST(ReferencePicture, ItsErrorFallsAsPromisedAndHoldsTheTruth) {
  const Scene scene = busy_scene();
  const ReferencePicture few = render(scene, samples(32)), many = render(scene, samples(512));
  ASSERT_TRUE(few.mean_error && many.mean_error);
  // Sixteen times the samples: a quarter of the error, or less with a pattern that fills evenly.
  EXPECT_LT(*many.mean_error, *few.mean_error / 3.5);
  int within_two = 0, beyond_six = 0, uncertain = 0;
  for (std::size_t i = 0; i < few.radiance.pixels.size(); ++i) {
    const double sigma = std::hypot(few.standard_error[i].y, many.standard_error[i].y);
    if (sigma < 1e-5) continue;
    const double off = std::abs(few.radiance.pixels[i].y - many.radiance.pixels[i].y) / sigma;
    ++uncertain;
    within_two += off < 2.0 ? 1 : 0;
    beyond_six += off > 6.0 ? 1 : 0;
  }
  // Eight batches: Student's t with seven degrees, 91% within two and 0.05% beyond six.
  EXPECT_GT(uncertain, 1000);
  EXPECT_GT(within_two, 0.85 * uncertain);
  EXPECT_LT(beyond_six, 0.01 * uncertain);
}

TEST(ReferencePicture, OneSampleTellsNothingOfItsError) {
  const ReferencePicture one = render(busy_scene(), samples(1));
  EXPECT_FALSE(one.mean_error.has_value());
  EXPECT_TRUE(one.standard_error.empty());
}

TEST(ReferencePicture, BatchesDrawnApartAreThePictureToTheLastBit) {
  const Scene scene = busy_scene();
  for (const std::uint32_t count : {1u, 3u, 11u}) {
    const ReferenceSettings settings = samples(count);
    const ReferencePicture whole = render(scene, settings);
    const std::uint32_t batches = batches_of(settings);
    EXPECT_EQ(batches, std::min(count, 8u));
    std::vector<ReferenceBatches> parts;  // of one, two, one, two batches ..., the last first
    for (std::uint32_t first = 0, size = 1; first < batches; first += size, size = 3 - size) {
      size = std::min(size, batches - first);
      parts.insert(parts.begin(), render_batches(scene, settings, first, size));
    }
    const ReferencePicture merged = merge_batches(parts);
    EXPECT_EQ(merged.radiance.pixels, whole.radiance.pixels);
    EXPECT_EQ(merged.standard_error, whole.standard_error);
    EXPECT_EQ(merged.mean_error, whole.mean_error);
  }
}

TEST(ReferencePicture, ThreadsChangeNoBit) {
  const Scene scene = busy_scene();
  const ReferencePicture one = render(scene, samples(8, 1)), four = render(scene, samples(8, 4));
  ASSERT_EQ(one.radiance.pixels.size(), four.radiance.pixels.size());
  EXPECT_EQ(std::memcmp(one.radiance.pixels.data(), four.radiance.pixels.data(),
                        one.radiance.pixels.size() * sizeof(glm::vec3)),
            0);
}

TEST(ReferencePicture, ThroughTheCentreEdgesAreSharpAndTexturesAveraged) {
  // Pixels are 2 blocks wide at the lamp's front, which lies inside one and over its centre.
  Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0},
                          {single_block(world::block::kLamp, {-1.1, 1.2, 1000.5})}, 4, 0.004);
  scene.albedo.reset();
  // The footprint is as wide as two textures, so that it sees their mean.
  glm::dvec3 mean(0.0);
  for (int i = 0; i < 32 * 32; ++i) {
    const glm::dvec3 texel(i % 32 + 0.5, i / 32 + 0.5, 0.0);
    mean += glm::dvec3(BlockTexels::shared().texel(world::block::kLamp, 5, texel / 32.0)) / 1024.0;
  }
  const double lit = mean.x * world::block_types()[world::block::kLamp].emission;
  for (const bool centred : {true, false}) {
    ReferenceSettings settings = samples(4096);
    settings.filter = centred ? game::ReferenceFilter::kCentre : game::ReferenceFilter::kPixel;
    const ReferencePicture picture = render(scene, settings);
    const auto brightest =
        std::max_element(picture.radiance.pixels.begin(), picture.radiance.pixels.end(),
                         [](glm::vec3 a, glm::vec3 b) { return a.x < b.x; });
    EXPECT_NEAR(brightest->x, centred ? lit : 0.25 * lit, 5e-3 * lit);
  }
}

TEST(ReferencePicture, OfATorchTheFlameEmitsAndTheStickDoesNot) {
  Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0},
                          {single_block(world::block::kTorch, {0.0, 0.0, 10.0})}, 32, 0.05);
  scene.albedo.reset();
  scene.environment = glm::dvec3(0.0);
  const ReferencePicture picture = render(scene, samples(16));
  const auto at = [&](int row) {
    return picture.radiance.pixels[static_cast<std::size_t>(row * 32 + 16)];
  };
  for (int row = 18; row < 30; ++row) EXPECT_EQ(at(row), glm::vec3(0.0f)) << row;
  EXPECT_GT(at(9).x, 5.0f);
}

TEST(ReferencePicture, APixelIsTheMeanOfWhatItCovers) {
  // A pixel 2 blocks wide at the block's front; the block covers a quarter of it.
  Scene scene = seen_from({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0},
                          {single_block(world::block::kStone, {0.0, 0.0, 10.5})}, 1, 0.1);
  scene.environment = glm::dvec3(0.0);
  scene.bodies = {{{0.0, 0.0, -1.0}, glm::dvec3(3.14159265358979), 0.0}};
  const ReferencePicture picture = render(scene, samples(4096));
  EXPECT_NEAR(picture.radiance.pixels[0].x, 0.25, 2e-3);
}

TEST(ReferenceSampler, PointsFallOneIntoEachElementaryInterval) {
  for (const int log_columns : {0, 2, 4, 6}) {
    std::vector<int> cells(64);
    for (std::uint32_t i = 0; i < 64; ++i) {
      Sampler sampler(99, 1, i);
      sampler.next();
      const glm::dvec2 p = sampler.next();
      ASSERT_TRUE(p.x >= 0.0 && p.x < 1.0 && p.y >= 0.0 && p.y < 1.0);
      const int columns = 1 << log_columns, rows = 64 / columns;
      ++cells[static_cast<std::size_t>(static_cast<int>(p.x * columns) +
                                       columns * static_cast<int>(p.y * rows))];
    }
    EXPECT_EQ(std::count(cells.begin(), cells.end(), 1), 64) << log_columns;
  }
}

TEST(ReferenceSampler, PixelsBatchesAndPairsAreIndependent) {
  double with_pixel = 0.0, with_batch = 0.0, with_pair = 0.0;
  constexpr int kCount = 4096;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    Sampler a(i, 0, 0), b(i + 1, 0, 0), c(i, 1, 0);
    const double x = a.next().x - 0.5;
    with_pixel += x * (b.next().x - 0.5);
    with_batch += x * (c.next().x - 0.5);
    with_pair += x * (a.next().x - 0.5);
  }
  // Correlations of independent numbers: within four of their deviations, 1/12 / sqrt(count).
  const double bound = 4.0 / 12.0 * std::sqrt(static_cast<double>(kCount));
  EXPECT_LT(std::abs(with_pixel), bound);
  EXPECT_LT(std::abs(with_batch), bound);
  EXPECT_LT(std::abs(with_pair), bound);
}

TEST(ReferenceDevelop, BlackStaysBlackAndGreyTakesTheCurve) {
  measure::Picture picture{3, 1, {glm::vec3(0.0f), glm::vec3(0.25f), glm::vec3(1e9f)}};
  const std::vector<std::uint8_t> out = develop(picture, -2.0);
  ASSERT_EQ(out.size(), 12u);
  // 1 is raised to 1 + 2 / 401, through the curve: 1.034701 / 1.666758 = 0.62079, in sRGB 0.80993,
  // of 255: 206.53.
  // The brightest is 12 through the curve: 144.29494 / 147.09047 = 0.98099, in sRGB 0.99160: 253.
  const std::vector<std::uint8_t> expected{0, 0, 0, 255, 207, 207, 207, 255, 253, 253, 253, 255};
  EXPECT_EQ(out, expected);
}

TEST(ReferenceScene, ADebugViewHasNoReference) {
  game::SceneOptions options;
  options.settings.render.debug_view = render::DebugView::kNormal;
  const auto refused = render_reference(options, {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("debug.view"), std::string::npos);
}

TEST(ReferenceScene, WhatIsLeftOutHasNoReference) {
  game::SceneOptions options;
  ASSERT_TRUE(game::apply_setting("leave.out=haze", options.settings));
  const auto refused = render_reference(options, {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("leave.out"), std::string::npos);
}

}  // namespace
}  // namespace skerry::reference
