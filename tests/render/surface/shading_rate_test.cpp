// Light at fewer pixels against light at every pixel.
#include <algorithm>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <random>

#include "engine/render/light/lights.h"
#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{203, 121};  // no multiple of any step
constexpr glm::dvec3 kEye{20.3, 9.1, 4.7};

/// Terraces of many materials, metal among them, with ferns and a few pillars.
world::BlockId terraces(int x, int y, int z) {
  const int ground = (x * x / 37 + z * z / 51) % 9 - 6;
  const bool pillar = x % 9 == 4 && z % 8 == 5;
  if (y <= ground - 1 || (pillar && y < 4)) {
    const int kind = (x + 3 * z) % 7;
    return kind < 2    ? world::block::kMarble
           : kind == 2 ? world::block::kGoldOre
           : kind == 3 ? world::block::kStone
                       : world::block::kGrass;
  }
  if (y == ground && (x * 7 + z * 3) % 11 == 0) return world::block::kFern;
  return world::block::kAirBlock;
}

/// Steps down all about, whose sides the eye above does not see, and a wall that shades them.
world::BlockId pyramid(int x, int y, int z) {
  const int steps = std::max(std::abs(x - 32), std::abs(z - 32)) / 5;
  const bool wall = x == 36 && z > 30 && z < 44 && y < 10;
  return wall || y <= 4 - 2 * steps ? world::block::kMarble : world::block::kAirBlock;
}

std::vector<shared::Light> lamps() {
  std::mt19937 random(5);
  const auto in = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random()) / 4294967296.0f;
  };
  std::vector<shared::Light> out;
  for (std::uint32_t i = 0; i < 40; ++i) {
    shared::Light light{};
    light.position = glm::vec3(glm::dvec3(in(0, 63), in(-4, 5), in(0, 63)) - kEye);
    light.range = in(3.0f, 12.0f);
    light.intensity = {in(0.1f, 2.0f), in(0.1f, 2.0f), in(0.1f, 2.0f)};
    light.kind = i % 2 == 0 ? shared::kLightPoint : shared::kLightSphere;
    light.axis = {0.0f, 1.0f, 0.0f};
    light.size = 0.3f;
    light.cos_outer = -0.5f;
    light.cos_inner = 0.5f;
    const Result<shared::Light> taken = checked_light(light);
    EXPECT_TRUE(taken) << taken.error().message;
    out.push_back(*taken);
  }
  return out;
}

class ShadingRate : public RendererOnGpu {
 protected:
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  const std::vector<shared::Light> lamps_ = lamps();

  /// @param blocks of the islands.
  explicit ShadingRate(world::BlockId (*blocks)(int, int, int) = terraces) : blocks_(blocks) {}
  world::BlockId (*const blocks_)(int, int, int);

  void SetUp() override {
    RendererOnGpu::SetUp();
    if (!HasFatalFailure()) add(blocks_, {0, -1, 0}, {1, 1, 1});
  }
  FrameInput view() const {
    FrameInput in;
    in.islands = islands_;
    in.reach_blocks = 200.0;
    in.sky = sun_at(35.0, 60.0);
    in.camera = camera_at(kEye, 20.0, -25.0, 80.0);
    in.lights = lamps_;
    in.exposure_ev = -1.0f;
    return in;
  }
  static RenderSettings settings(int rate, float tolerance) {
    RenderSettings out;
    out.shading_rate = rate;
    out.shading_tolerance = tolerance;
    return out;
  }
  struct Apart {
    double mean = 0.0;   ///< of a pixel's largest channel, as a share of the picture's mean
    double most = 0.0;   ///< as a share of the pixel itself
    double wrong = 0.0;  ///< share of pixels that are wrong by more than a tenth
  };
  static Apart apart(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& truth) {
    Apart out;
    EXPECT_EQ(a.size(), truth.size());
    double light = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const glm::dvec3 difference = glm::abs(glm::dvec3(a[i]) - glm::dvec3(truth[i]));
      const double bright = std::max({truth[i].x, truth[i].y, truth[i].z, 1e-4f});
      const double most = std::max({difference.x, difference.y, difference.z});
      const double off = most / bright;
      out.mean += most;
      light += bright;
      out.most = std::max(out.most, off);
      out.wrong += off > 0.1 ? 1.0 / static_cast<double>(truth.size()) : 0.0;
    }
    out.mean /= light;
    return out;
  }
};

class SquaresOfLight : public ShadingRate {
 protected:
  SquaresOfLight() : ShadingRate(pyramid) {}
};

// Where nothing may differ, each pixel has light of its own or that of points with the same light.
TEST_F(ShadingRate, WithoutToleranceItIsThePictureOfEveryPixel) {
  FrameInput night = view();
  night.sky = celestial_at(0.0, 0.0);
  FrameInput unlit = view();
  unlit.lights = {};
  for (const FrameInput& input : {view(), night, unlit}) {
    for (const bool shadows : {true, false}) {
      RenderSettings every = settings(1, 0.0f);
      every.shadow_enabled = shadows;
      every.lights_shadows = kEveryLight;
      const std::vector<glm::vec4> truth = radiance(input, every, kSize);
      for (const int rate : {2, 3, 4}) {
        SCOPED_TRACE(rate);
        RenderSettings fewer = every;
        fewer.shading_rate = rate;
        const Apart off = apart(radiance(input, fewer, kSize), truth);
        EXPECT_LT(off.most, 1.0 / 256.0) << "half floats keep 11 bits of a black and a white one";
      }
    }
  }
}

TEST_F(ShadingRate, WithToleranceFewPixelsAreWrong) {
  const std::vector<glm::vec4> truth = radiance(view(), settings(1, 0.0f), kSize);
  double last = 0.0;
  for (const float tolerance : {0.03f, 0.1f, 0.3f}) {
    for (const int rate : {2, 4}) {
      SCOPED_TRACE(testing::Message() << rate << ", " << tolerance);
      const Apart off = apart(radiance(view(), settings(rate, tolerance), kSize), truth);
      // Pixels here are large: a pillar is five wide, and a square of points as wide as its shadow.
      EXPECT_LT(off.mean, 0.02 + 0.05 * static_cast<double>(tolerance));
      EXPECT_LT(off.wrong, rate == 2 ? 0.02 : 0.04);
      if (rate == 4) {
        EXPECT_GE(off.mean, last);
        last = off.mean;
      }
    }
  }
  EXPECT_GT(last, 1e-4) << "no light was shared";
}

// Planes, textures and edges of shadows in squares whose pixels all name one face of one block,
// which lies at another height beyond each step.
TEST_F(SquaresOfLight, LookAsEveryPixelDoes) {
  FrameInput in = view();
  in.camera = camera_at({32.3, 26.0, 31.7}, 33.0, -86.0, 75.0);
  in.lights = {};
  const std::vector<glm::vec4> truth = radiance(in, settings(1, 0.0f), kSize);
  const Apart off = apart(radiance(in, settings(4, 0.1f), kSize), truth);
  EXPECT_GT(off.mean, 1e-5) << "no light was shared";
  EXPECT_LT(off.mean, 0.009) << "a texture turned about its square is off by 0.011";
  EXPECT_LT(off.wrong, 0.015) << "light of a square's upper points alone: 0.020";
}

TEST_F(ShadingRate, TwoRunsGiveTheSameBytes) {
  const std::vector<glm::vec4> first = radiance(view(), settings(4, 0.1f), kSize);
  for (int again = 0; again < 3; ++again)
    EXPECT_EQ(radiance(view(), settings(4, 0.1f), kSize), first);
}

TEST_F(ShadingRate, StillsAndStoredNormalsAreLitAtEveryPixel) {
  RenderSettings still = settings(4, 0.1f);
  drawn(view(), still, kSize);
  EXPECT_TRUE(has_pass("shade_samples"));
  EXPECT_FALSE(has_pass("shade_surfaces"));
  EXPECT_FALSE(has_pass("shade_lights"));
  still.aa_samples = 4;
  drawn(view(), still, kSize);
  EXPECT_FALSE(has_pass("shade_samples"));
  RenderSettings stored = settings(4, 0.1f);
  stored.gbuffer.normal = NormalStore::kOct16;
  drawn(view(), stored, kSize);
  EXPECT_FALSE(has_pass("shade_samples"));
}

}  // namespace
}  // namespace skerry::render
