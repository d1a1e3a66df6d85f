// Frames under many lights: clusters lose none, and a frame without lights has nothing of them.
#include <array>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <random>

#include "engine/render/light/lights.h"
#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{200, 120};

/// Hills of marble and grass about a pond, with ferns.
world::BlockId valley(int x, int y, int z) {
  const int ground = (x * x / 37 + z * z / 51) % 9 - 6;
  if (y <= ground - 1) return (x + z) % 7 < 2 ? world::block::kMarble : world::block::kGrass;
  if (y < -2) return world::block::kWater;
  if (y == ground && (x * 7 + z * 3) % 11 == 0) return world::block::kFern;
  return world::block::kAirBlock;
}

/// A hall with pillars, under a roof with holes.
world::BlockId hall(int x, int y, int z) {
  const bool roof = y >= 2 && y < 5 && (x / 5 + z / 7) % 4 != 0;
  const bool pillar = y < 2 && x % 9 < 2 && z % 11 < 2;
  if (y < -6 || roof || pillar) return world::block::kMarble;
  return y == -6 && (x * 7 + z * 3) % 23 == 0 ? world::block::kFern : world::block::kAirBlock;
}

shared::Light checked(const shared::Light& light) {
  const Result<shared::Light> taken = checked_light(light);
  EXPECT_TRUE(taken) << taken.error().message;
  return *taken;
}

/// Lights of every kind in `kinds` about the valley, relative to a camera at `eye`.
std::vector<shared::Light> scattered(std::size_t count, glm::dvec3 eye, std::uint32_t seed,
                                     float reach = 1.0f,
                                     std::initializer_list<std::uint32_t> kinds = {
                                         shared::kLightPoint, shared::kLightSpot,
                                         shared::kLightTube, shared::kLightSphere}) {
  std::mt19937 random(seed);
  const auto in = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random()) / 4294967296.0f;
  };
  std::vector<shared::Light> out;
  for (std::size_t i = 0; i < count; ++i) {
    shared::Light light{};
    light.position = glm::vec3(glm::dvec3(in(0, 63), in(-6, 5), in(0, 63)) - eye);
    light.range = reach * in(0.5f, 9.0f);
    light.intensity = {in(0.0f, 2.0f), in(0.0f, 2.0f), in(0.0f, 2.0f)};
    light.kind = std::data(kinds)[random() % kinds.size()];
    if (light.kind == shared::kLightSpot && random() % 2 == 0) light.kind |= shared::kLightDualBit;
    light.axis = {in(-1, 1), in(-1, 1), in(-1, 1)};
    light.size = in(0.0f, 1.5f);
    light.cos_outer = in(-0.9f, 0.9f);
    light.cos_inner = in(light.cos_outer, 1.0f);
    out.push_back(checked(light));
  }
  return out;
}

class LitFrames : public RendererOnGpu {
 protected:
  static constexpr glm::dvec3 kEye{20.3, 9.1, 4.7};
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};

  void SetUp() override {
    RendererOnGpu::SetUp();
    if (HasFatalFailure()) return;
    add(valley, {0, -1, 0}, {1, 1, 1});
  }
  /// A night without moon.
  FrameInput night(std::span<const shared::Light> lights, glm::dvec3 eye = kEye) const {
    FrameInput in;
    in.islands = islands_;
    in.sky = celestial_at(0.0, 0.0);
    in.camera = camera_at(eye, 20.0, -25.0, 80.0);
    in.lights = lights;
    in.exposure_ev = -1.0f;
    return in;
  }
  std::vector<std::byte> radiance(FrameInput input, const RenderSettings& settings = {}) {
    input.capture = true;
    const FrameReport report = drawn(input, settings, kSize);
    EXPECT_EQ(report.pixels.non_finite, 0u);
    return renderer().captured(Capture::kRadiance).texels;
  }
  /// The same frame by clusters and by asking every light for every pixel.
  void expect_as_oracle(const FrameInput& input, RenderSettings settings = {}) {
    const std::vector<std::byte> clustered = radiance(input, settings);
    settings.lights_oracle = true;
    const std::vector<std::byte> all = radiance(input, settings);
    ASSERT_EQ(clustered.size(), all.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < all.size(); i += 8)
      different += std::memcmp(&clustered[i], &all[i], 8) != 0 ? 1 : 0;
    EXPECT_EQ(different, 0u);
    FrameInput dark = input;
    dark.lights = {};
    EXPECT_NE(radiance(dark), all) << "the lights light nothing";
  }
};

TEST_F(LitFrames, APictureByClustersIsThePictureByAllLights) {
  for (const std::size_t count : {1u, 31u, 255u, 256u, 257u, 1000u}) {
    SCOPED_TRACE(count);
    expect_as_oracle(night(scattered(count, kEye, static_cast<std::uint32_t>(count))));
  }
}

TEST_F(LitFrames, EveryKindAloneIsLitTheSame) {
  for (const std::uint32_t kind : {shared::kLightPoint, shared::kLightSpot, shared::kLightTube,
                                   shared::kLightSphere, shared::kLightDirectional}) {
    SCOPED_TRACE(kind);
    const std::vector<shared::Light> lights = scattered(40, kEye, 7 + kind, 1.0f, {kind});
    expect_as_oracle(night(lights));
  }
}

TEST_F(LitFrames, UnderWaterAndByDayAndWithCoarseDepthsToo) {
  const glm::dvec3 under{9.3, -3.4, 5.2};
  const std::vector<shared::Light> lights = scattered(200, under, 3);
  FrameInput input = night(lights, under);
  input.camera_medium = world::block::kWater;
  expect_as_oracle(input);

  const std::vector<shared::Light> above = scattered(200, kEye, 4);
  input = night(above);
  input.sky = sun_at(30.0, 60.0);
  expect_as_oracle(input);
  RenderSettings settings;
  settings.gbuffer.depth = DepthStore::kD16;
  settings.gbuffer.normal = NormalStore::kOct16;
  settings.shading = Shading::kFlat;
  expect_as_oracle(input, settings);
}

// Tiles that get no sun are shaded by a program that does not look for it.
TEST_F(LitFrames, TilesWithoutSunLookAsIfEveryPixelHadAskedForIt) {
  restart();
  add(hall, {0, -1, 0}, {1, 1, 1});
  RenderSettings settings;
  settings.indirect = Indirect::kOff;
  settings.leave_out.add(Feature::kHaze);
  std::vector<Celestial> skies{celestial_at(0.0, 0.5)};  // of a full moon
  for (const double altitude : {2.0, 20.0, 45.0, 70.0, 89.0})
    skies.push_back(sun_at(altitude, 25.0 + 3.0 * altitude));
  std::size_t pixels = 0, dark = 0;
  for (const Celestial& sky : skies) {
    for (const double yaw : {20.0, 140.0, 260.0}) {
      for (const float blur : {0.0f, 0.15f}) {
        FrameInput input = night({});
        input.sky = sky;
        input.camera = camera_at({30.3, -2.9, 28.7}, yaw, -12.0, 80.0);
        settings.shadow_blur = blur;
        settings.lights_oracle = false;
        const std::vector<std::byte> by_tiles = radiance(input, settings);
        settings.lights_oracle = true;
        const std::vector<std::byte> by_pixels = radiance(input, settings);
        ASSERT_EQ(by_tiles, by_pixels) << sky.to_sun.y << " " << yaw << " " << blur;
        constexpr std::array<std::byte, 6> kNoLight{};
        for (std::size_t i = 0; i < by_pixels.size(); i += 8, ++pixels)
          dark += std::memcmp(&by_pixels[i], kNoLight.data(), kNoLight.size()) == 0 ? 1 : 0;
      }
    }
  }
  // Both kinds are there.
  EXPECT_GT(dark, pixels / 4);
  EXPECT_LT(dark, pixels * 19 / 20);
}

TEST_F(LitFrames, ListsThatDoNotFitAreAskedForAmongAllLightsAndFitLater) {
  // Every light reaches every cluster: far more entries than there is room for at first.
  const std::vector<shared::Light> lights = scattered(300, kEye, 5, 60.0f);
  const FrameInput input = night(lights);
  const std::vector<std::byte> first = radiance(input);
  const FrameReport early = *renderer().report();
  EXPECT_GT(early.clusters.units, 300u * 64u);
  const std::vector<std::byte> second = radiance(input), third = radiance(input);
  EXPECT_EQ(first, second);
  EXPECT_EQ(first, third);
  expect_as_oracle(input);
}

TEST_F(LitFrames, ManyLightsInOneClusterAreAllCounted) {
  // A fixed small light, 10,000 times over, is 10,000 times as bright.
  shared::Light one{};
  one.kind = shared::kLightPoint;
  one.position = {0.5f, -9.0f, 10.0f};
  one.range = 12.0f;
  one.intensity = glm::vec3(1e-3f);
  const std::vector<shared::Light> many(10000, checked(one));
  shared::Light strong = one;
  strong.intensity = glm::vec3(10.0f);
  const std::vector<shared::Light> single{checked(strong)};
  const auto halves = [&](const std::vector<shared::Light>& lights) {
    const std::vector<std::byte> texels = radiance(night(lights));
    std::vector<std::uint16_t> out(texels.size() / 2);
    std::memcpy(out.data(), texels.data(), texels.size());
    return out;
  };
  const std::vector<std::uint16_t> summed = halves(many), at_once = halves(single);
  std::size_t lit = 0;
  for (std::size_t i = 0; i < summed.size(); ++i) {
    const float a = glm::unpackHalf1x16(summed[i]), b = glm::unpackHalf1x16(at_once[i]);
    EXPECT_NEAR(a, b, 2e-3f * b + 1e-6f);
    lit += b > 0.01f ? 1 : 0;
  }
  EXPECT_GT(lit, 100u);
}

TEST_F(LitFrames, TwoRunsGiveTheSameBytes) {
  const std::vector<shared::Light> lights = scattered(500, kEye, 11);
  const std::vector<std::byte> first = radiance(night(lights));
  for (int again = 0; again < 3; ++again) EXPECT_EQ(radiance(night(lights)), first);
  restart();
  add(valley, {0, -1, 0}, {1, 1, 1});
  EXPECT_EQ(radiance(night(lights)), first);
}

TEST_F(LitFrames, AFrameWhoseLightsAreOutOfViewHasNoPassOfThem) {
  shared::Light behind{};
  behind.position = {0.0f, 0.0f, -30.0f};
  behind.range = 10.0f;
  behind.intensity = glm::vec3(1.0f);
  const std::vector<shared::Light> lights{checked(behind)};
  for (int frame = 0; frame < 3; ++frame) drawn(night({}), {}, kSize);
  const int pipelines = renderer().pipelines_created();
  const std::uint64_t memory = device().memory_total();
  drawn(night(lights), {}, kSize);
  EXPECT_FALSE(has_pass("lights") || has_pass("light_"));
  EXPECT_EQ(renderer().pipelines_created(), pipelines);
  EXPECT_EQ(device().memory_total(), memory);
  const std::vector<shared::Light> near = scattered(3, kEye, 1);
  EXPECT_EQ(drawn(night(near), {}, kSize).lights, 3u);
  EXPECT_TRUE(has_pass("shade_lights"));
  RenderSettings without;
  without.leave_out.add(Feature::kLights);
  drawn(night(near), without, kSize);
  EXPECT_FALSE(has_pass("lights") || has_pass("light_"));
}

}  // namespace
}  // namespace skerry::render
