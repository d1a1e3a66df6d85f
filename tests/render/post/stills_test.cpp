// Pictures made of many samples: what is averaged is what single pictures show, and the mean of
// many suns is the sun's disc.

#include "tests/render/high_roof.h"

#include <algorithm>
#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{80, 50};

class Stills : public RendererOnGpu {
 protected:
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
};

// Of what is solid: leaves and plants take their finest texels where several samples make a pixel.
TEST_F(Stills, ASampledPixelIsTheMeanOfTheSamplesOfALargerPicture) {
  add(
      [](int x, int y, int z) -> world::BlockId {
        return y < 0                        ? world::block::kStone
               : y < 3 && x * x + z * z < 9 ? world::block::kStone
                                            : world::block::kAirBlock;
      },
      {-1, -1, -1}, {1, 1, 1});
  FrameInput input;
  input.islands = islands_;
  input.sky = sun_at(50.0, 30.0);
  input.camera = camera_at({2.0, 5.0, -9.0}, -10.0, -20.0, 60.0);
  RenderSettings settings;
  settings.shadow_enabled = false;  // the samples of a pixel take their taps at places of their own
  input.reach_blocks = 200.0;
  for (const int edge : {2, 4}) {
    settings.aa_samples = edge * edge;
    const std::vector<glm::vec4> averaged = radiance(input, settings, kSize);
    settings.aa_samples = 1;
    const auto n = static_cast<std::uint32_t>(edge);
    const std::vector<glm::vec4> samples =
        radiance(input, settings, {kSize.width * n, kSize.height * n});
    ASSERT_EQ(averaged.size() * n * n, samples.size());
    double difference = 0.0;
    for (std::uint32_t y = 0; y < kSize.height; ++y)
      for (std::uint32_t x = 0; x < kSize.width; ++x) {
        double mean = 0.0;
        for (std::uint32_t j = 0; j < n; ++j)
          for (std::uint32_t i = 0; i < n; ++i)
            mean += static_cast<double>(samples[(y * n + j) * kSize.width * n + x * n + i].y);
        mean /= n * n;
        const double got = static_cast<double>(averaged[y * kSize.width + x].y);
        difference = std::max(difference, std::abs(got - mean) / std::max(mean, 1e-3));
      }
    EXPECT_LT(difference, 1.0 / 1024.0) << "half floats keep 11 bits";
  }
}

TEST_F(Stills, ManySunsAreOneDisc) {
  add(high_roof, {-1, -1, -1}, {1, 1, 1});
  FrameInput input;
  input.islands = islands_;
  input.sky = sun_at(60.0, 90.0);
  const double sine = std::sin(M_PI / 3.0), edge = -60.0 / std::tan(M_PI / 3.0);
  const double radius = 0.00465 * 60.0 / sine;  // of the penumbra, across the light
  input.camera = camera_at({edge, 2.5, -2.0}, 0.0, -70.0, 50.0);
  RenderSettings settings;
  input.reach_blocks = 200.0;
  settings.shadow_blur = 0.0f;
  const glm::dvec3 eye = blocks_at(input.camera.position);
  settings.shadow_enabled = false;
  const std::vector<glm::vec4> full = radiance(input, settings, kSize);
  settings.shadow_enabled = true;
  double last = 1.0;
  for (const std::uint32_t parts : {1u, 4u, 16u, 64u}) {
    input.parts = parts;
    const std::vector<glm::vec4> mean = radiance(input, settings, kSize);
    double squares = 0.0;
    int partly = 0;
    for (std::uint32_t i = 0; i < mean.size(); ++i) {
      const glm::dvec3 ray =
          ray_of(input.camera, i % kSize.width, i / kSize.width, kSize.width, kSize.height);
      const double x = eye.x - ray.x * eye.y / ray.y;
      const double d = (edge - x) * sine / radius, expected = share_of_disc(d);
      const double error = static_cast<double>(mean[i].y / full[i].y) - expected;
      partly += std::abs(d) < 1.0 ? 1 : 0;
      squares += error * error;
    }
    ASSERT_GT(partly, 200);
    const double error = std::sqrt(squares / partly);
    EXPECT_LT(error, 0.75 * last) << parts << " suns";
    last = error;
  }
  EXPECT_LT(last, 0.02);
}

TEST_F(Stills, TheTotalOfPartsIsMadeForThemAlone) {
  add([](int, int y,
         int) -> world::BlockId { return y < 0 ? world::block::kStone : world::block::kAirBlock; },
      {0, -1, 0}, {1, 0, 1});
  FrameInput input;
  input.islands = islands_;
  input.sky = sun_at(60.0, 90.0);
  input.camera = camera_at({2.0, 2.5, 2.0}, 0.0, -30.0, 50.0);
  const auto has_total = [&] {
    device().collect();
    const std::vector<gpu::MemoryUse> all = device().memory_use();
    return std::any_of(all.begin(), all.end(),
                       [](const gpu::MemoryUse& use) { return use.name == "total of parts"; });
  };
  drawn(input, {}, kSize);
  EXPECT_FALSE(has_total());
  EXPECT_FALSE(has_pass("accumulate_part"));
  EXPECT_FALSE(has_pass("average_samples"));
  const std::vector<std::uint8_t> alone = picture();
  input.parts = 2;
  for (input.part = 0; input.part < 2; ++input.part) drawn(input, {}, kSize);
  EXPECT_TRUE(has_total());
  EXPECT_TRUE(has_pass("accumulate_part"));
  input.part = 0;
  input.parts = 1;
  drawn(input, {}, kSize);
  EXPECT_EQ(picture(), alone);
  EXPECT_FALSE(has_total());
}

}  // namespace
}  // namespace skerry::render
