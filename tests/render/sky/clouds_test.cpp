// Clouds as the renderer draws them, against closed forms and against themselves.
#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

#include "tests/render/renderer_on_gpu.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{48, 32};

/// A box of `edge` samples of one value about the origin; its faces are ramps of one sample.
CloudVolumeDesc even_box(int edge, float value, const glm::dmat4& blocks_from_index) {
  CloudVolumeDesc out;
  out.blocks_from_index = blocks_from_index;
  out.tiles.push_back({{0, 0, 0}, edge, value});
  return out;
}

class CloudsOnGpu : public RendererOnGpu {
 protected:
  std::vector<glm::vec4> radiance(const FrameInput& input, const RenderSettings& settings,
                                  VkExtent2D size = kSize) {
    return RendererOnGpu::radiance(input, settings, size);
  }
  void set(std::span<const CloudVolumeDesc> volumes,
           CloudPrecision precision = CloudPrecision::k32) {
    const Result<void> done = renderer().set_clouds(volumes, precision);
    ASSERT_TRUE(done) << done.error().message;
  }
};

/// A sky that can be seen, but no light: clouds only occlude.
Celestial dusk() {
  Celestial sky = celestial_at(12.0 * 3600.0, 0.0);
  sky.sun_irradiance = glm::vec3(0.0f);
  sky.sun_casts = false;
  return sky;
}

/// Blocks of a ray inside a box with ramps: along each axis it holds `edge` samples at 0..edge-1.
/// For a ray that enters and leaves through faces at right angles nearly, each ramp counts half.
double optical_length(glm::dvec3 origin, glm::dvec3 dir, int edge) {
  // By fine steps: trilinear, so the product of the axes' ramps.
  const auto ramp = [&](double x) { return std::clamp(std::min(x + 1.0, edge - x), 0.0, 1.0); };
  double sum = 0.0;
  constexpr double kStep = 1.0 / 256.0;
  for (double t = 0.5 * kStep; t < 200.0; t += kStep) {
    const glm::dvec3 p = origin + dir * t;
    sum += ramp(p.x) * ramp(p.y) * ramp(p.z) * kStep;
  }
  return sum;
}

TEST_F(CloudsOnGpu, AnEvenBoxLetsThroughWhatItsDepthLeaves) {
  const double scale = 1.5;
  const glm::dmat4 turned = glm::rotate(glm::scale(glm::dmat4(1.0), glm::dvec3(scale)), 0.4,
                                        glm::normalize(glm::dvec3(1, 2, 3)));
  FrameInput input;
  input.sky = dusk();
  input.camera = camera_at({7.0, 12.0, -60.0}, 0.0, 0.0, 35.0);
  RenderSettings settings;
  settings.indirect = Indirect::kOff;  // clouds are black
  settings.clouds.resolution = 1;
  settings.clouds.steps = 256;
  settings.clouds.file_density = 1.0f;
  const std::vector<glm::vec4> clear = radiance(input, settings);
  const glm::dmat4 index_from_blocks = glm::inverse(turned);
  for (const float density : {1e-4f, 0.01f, 0.1f, 1.0f}) {
    const CloudVolumeDesc box = even_box(16, density, turned);
    set(std::span(&box, 1));
    const std::vector<glm::vec4> seen = radiance(input, settings);
    double off = 0.0;
    int crossed = 0;
    for (std::uint32_t i = 0; i < seen.size(); i += 3) {
      const glm::dvec3 dir = glm::normalize(
          ray_of(input.camera, i % kSize.width, i / kSize.width, kSize.width, kSize.height));
      const glm::dvec3 eye(index_from_blocks * glm::dvec4(blocks_at(input.camera.position), 1.0));
      const glm::dvec3 along = glm::dmat3(index_from_blocks) * dir;
      const double length = optical_length(eye, glm::normalize(along), 16) / glm::length(along);
      const double left = std::exp(-static_cast<double>(density) * length);
      off = std::max(off, std::abs(static_cast<double>(seen[i].y / clear[i].y) - left));
      crossed += length > 10.0;
    }
    EXPECT_GT(crossed, 50);
    EXPECT_LT(off, 3e-3) << "half floats keep 11 bits; density " << density;
  }
}

TEST_F(CloudsOnGpu, TheEyeInsideABoxSeesWhatIsLeftOfItsWay) {
  const CloudVolumeDesc box = even_box(64, 0.05f, glm::dmat4(1.0));
  set(std::span(&box, 1));
  FrameInput input;
  input.sky = dusk();
  input.camera = camera_at({32.0, 32.0, 32.0}, 0.0, 0.0, 20.0);
  RenderSettings settings;
  settings.indirect = Indirect::kOff;  // clouds are black
  settings.clouds.resolution = 1;
  settings.clouds.steps = 128;
  settings.clouds.file_density = 1.0f;
  const std::vector<glm::vec4> seen = radiance(input, settings);
  settings.leave_out.add(Feature::kClouds);
  const std::vector<glm::vec4> clear = radiance(input, settings);
  const std::size_t middle = kSize.height / 2 * kSize.width + kSize.width / 2;
  // From 32 to the ramp's middle at 63.5.
  EXPECT_NEAR(seen[middle].y / clear[middle].y, std::exp(-0.05 * 31.5), 2e-3);
}

TEST_F(CloudsOnGpu, WithoutLightACloudIsBlackAndOnlyHidesWhatIsBehind) {
  const CloudVolumeDesc box = even_box(32, 5.0f, glm::translate(glm::dmat4(1.0), {-16, -16, 20}));
  set(std::span(&box, 1));
  FrameInput input;
  input.camera = camera_at({0.0, 0.0, 0.0}, 0.0, 0.0, 20.0);
  RenderSettings settings;
  settings.clouds.file_density = 1.0f;
  input.sky = celestial_at(0.0, 0.0);
  for (const glm::vec4& pixel : radiance(input, settings)) EXPECT_LT(pixel.y, 1e-3f);
  EXPECT_FALSE(has_pass("trace_cloud"));
  // At dusk the sky gives light, but in the strict look no sky does.
  input.sky = dusk();
  const std::size_t middle = kSize.height / 2 * kSize.width + kSize.width / 2;
  EXPECT_GT(radiance(input, settings)[middle].y, 1e-5f);
  EXPECT_TRUE(has_pass("trace_cloud_volumes"));
  settings.indirect = Indirect::kOff;
  EXPECT_LT(radiance(input, settings)[middle].y, 1e-6f);
}

TEST_F(CloudsOnGpu, WhatStandsBeforeACloudIsSeenUnchangedAndWhatStandsBehindIsHidden) {
  add(
      [](int, int, int z) -> world::BlockId {
        return z == 12 ? world::block::kStone : world::block::kAirBlock;
      },
      {-1, -1, 0}, {1, 1, 1});
  const std::vector<IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  FrameInput input;
  input.islands = islands;
  input.sky = sun_at(40.0, 180.0);
  input.camera = camera_at({0.5, 0.5, 0.5}, 0.0, 0.0, 60.0);
  RenderSettings settings;
  settings.shadow_enabled = false;
  settings.clouds.file_density = 1.0f;
  for (const int resolution : {1, 2}) {
    settings.clouds.resolution = resolution;
    set({});
    const std::vector<glm::vec4> clear = radiance(input, settings);
    CloudVolumeDesc box = even_box(32, 5.0f, glm::translate(glm::dmat4(1.0), {-16, -16, 20}));
    set(std::span(&box, 1));
    EXPECT_EQ(radiance(input, settings), clear) << "behind the wall";
    box.blocks_from_index = glm::scale(glm::translate(glm::dmat4(1.0), {-16, -16, 3}), {1, 1, 0.1});
    set(std::span(&box, 1));
    const std::vector<glm::vec4> hidden = radiance(input, settings);
    int changed = 0;
    for (std::size_t i = 0; i < hidden.size(); ++i) changed += hidden[i] != clear[i];
    EXPECT_EQ(changed, static_cast<int>(hidden.size())) << "before the wall";
  }
}

TEST_F(CloudsOnGpu, ACloudShadesTheGroundByWhatItLeavesOfTheLight) {
  add([](int, int y,
         int) -> world::BlockId { return y < 0 ? world::block::kStone : world::block::kAirBlock; },
      {-1, -1, -1}, {1, 0, 1});
  const std::vector<IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  FrameInput input;
  input.islands = islands;
  input.sky = sun_at(89.0, 0.0);
  input.camera = camera_at({0.0, 6.0, 0.0}, 0.0, -89.0, 20.0);
  RenderSettings settings;
  settings.shadow_enabled = false;
  settings.leave_out.add(Feature::kHaze);
  settings.clouds.file_density = 1.0f;
  const std::vector<glm::vec4> lit = radiance(input, settings);
  const CloudVolumeDesc box = even_box(64, 0.02f, glm::translate(glm::dmat4(1.0), {-32, 40, -32}));
  set(std::span(&box, 1));
  const std::vector<glm::vec4> shaded = radiance(input, settings);
  for (std::size_t i = 0; i < lit.size(); i += 7)
    EXPECT_NEAR(shaded[i].y / lit[i].y, std::exp(-0.02 * 64.0), 0.01);
}

TEST_F(CloudsOnGpu, SeveralVolumesTakeTheirOpticalDepthsTogether) {
  const glm::dmat4 at = glm::translate(glm::dmat4(1.0), {-16, -16, 10});
  const std::vector<CloudVolumeDesc> both{
      even_box(32, 0.02f, at),
      even_box(32, 0.03f, glm::translate(glm::dmat4(1.0), {-16, -16, 26}))};
  FrameInput input;
  input.sky = dusk();
  input.camera = camera_at({0.0, 0.0, 0.0}, 0.0, 0.0, 8.0);
  RenderSettings settings;
  settings.indirect = Indirect::kOff;  // clouds are black
  settings.clouds.file_density = 1.0f;
  settings.clouds.steps = 128;
  const std::vector<glm::vec4> clear = radiance(input, settings);
  set(both);
  const std::vector<glm::vec4> seen = radiance(input, settings);
  const double left = std::exp(-32.0 * (0.02 + 0.03));
  const std::size_t middle = kSize.height / 2 * kSize.width + kSize.width / 2;
  EXPECT_NEAR(seen[middle].y / clear[middle].y, left, 3e-3);
}

TEST_F(CloudsOnGpu, EmptinessIsNotPassedOverIntoWhatBeginsWithinIt) {
  // Two far corners of a box that is empty else, and a small box in its middle.
  CloudVolumeDesc sparse;
  sparse.blocks_from_index = glm::translate(glm::dmat4(1.0), {-128.0, -128.0, 10.0});
  sparse.tiles = {{{0, 0, 0}, 8, 0.01f}, {{248, 248, 248}, 8, 0.01f}};
  FrameInput input;
  input.sky = dusk();
  input.camera = camera_at({0.0, 0.0, 0.0}, 0.0, 0.0, 1.0);
  RenderSettings settings;
  settings.indirect = Indirect::kOff;  // clouds are black
  settings.clouds.file_density = 1.0f;
  settings.clouds.steps = 96;
  settings.clouds.resolution = 1;
  const std::vector<glm::vec4> clear = radiance(input, settings);
  const std::size_t middle = kSize.height / 2 * kSize.width + kSize.width / 2;
  for (const double z : {84.0, 91.0, 98.0, 105.0, 112.0}) {
    const std::vector<CloudVolumeDesc> both{
        sparse, even_box(8, 0.25f, glm::translate(glm::dmat4(1.0), {-3.5, -3.5, z}))};
    set(both);
    const std::vector<glm::vec4> seen = radiance(input, settings);
    EXPECT_NEAR(seen[middle].y / clear[middle].y, std::exp(-8.0 * 0.25), 4e-3) << z;
  }
}

TEST_F(CloudsOnGpu, TheSunsDiscDoesNotShineThroughADenseCloud) {
  FrameInput input;
  input.sky = sun_at(20.0, 0.0);
  input.camera = camera_at({0.0, 0.0, 0.0}, 0.0, 20.0, 4.0);
  RenderSettings settings;
  settings.clouds.file_density = 1.0f;
  const std::size_t middle = kSize.height / 2 * kSize.width + kSize.width / 2;
  const std::vector<glm::vec4> clear = radiance(input, settings);
  ASSERT_GT(clear[middle].y, 100.0f * clear[0].y) << "the disc is in view";
  // Thirty blocks and more of extinction 1 before the sun.
  const CloudVolumeDesc box = even_box(64, 1.0f, glm::translate(glm::dmat4(1.0), {-32, -24, 20}));
  set(std::span(&box, 1));
  for (const int resolution : {1, 2}) {
    settings.clouds.resolution = resolution;
    const std::vector<glm::vec4> seen = radiance(input, settings);
    EXPECT_GT(seen[middle].y, 0.0f);
    EXPECT_NEAR(seen[middle].y, seen[middle + 16].y, 0.1f * seen[middle + 16].y);
  }
}

TEST_F(CloudsOnGpu, AFireBehindAWallDoesNotShowOverItsEdgesAtHalfResolution) {
  add(
      [](int x, int, int z) -> world::BlockId {
        return z == 12 && x < 0 ? world::block::kStone : world::block::kAirBlock;
      },
      {-1, -1, 0}, {1, 1, 1});
  const std::vector<IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  FrameInput input;
  input.islands = islands;
  input.sky = dusk();
  // Turned, so that the edge passes through pixels of all four places in their square.
  input.camera = camera_at({0.5, 0.5, 0.5}, 3.0, 20.0, 60.0);
  RenderSettings settings;
  settings.indirect = Indirect::kOff;  // clouds are black
  settings.clouds.file_emission = 10.0f;
  const std::vector<glm::vec4> clear = radiance(input, settings);
  CloudVolumeDesc fire = even_box(64, 1.0f, glm::translate(glm::dmat4(1.0), {-32, -32, 16}));
  fire.role = CloudRole::kEmission;
  set(std::span(&fire, 1));
  settings.clouds.resolution = 1;
  const std::vector<glm::vec4> full = radiance(input, settings);
  settings.clouds.resolution = 2;
  const std::vector<glm::vec4> half = radiance(input, settings);
  int wall = 0;
  for (std::size_t i = 0; i < clear.size(); ++i) {
    if (full[i] != clear[i]) continue;
    ++wall;
    EXPECT_EQ(half[i], clear[i]) << "pixel " << i % kSize.width << ", " << i / kSize.width;
  }
  EXPECT_GT(wall, 300);
  EXPECT_LT(wall, static_cast<int>(clear.size()) - 300);
}

TEST_F(CloudsOnGpu, CloudsAskOnlyClustersThatAreWritten) {
  add(
      [](int x, int y, int z) -> world::BlockId {
        return z == 6 && x == 0 && y == 0 ? world::block::kStone : world::block::kAirBlock;
      },
      {-1, -1, 0}, {1, 1, 1});
  const std::vector<IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  FrameInput input;
  input.islands = islands;
  input.sky = dusk();
  input.camera = camera_at({0.5, 0.5, 0.5}, 0.0, 0.0, 60.0);
  // From about the eye to far beyond what a lamp reaches.
  const CloudVolumeDesc box = even_box(
      64, 0.004f, glm::scale(glm::translate(glm::dmat4(1.0), {-160, -160, -20}), {5, 5, 5}));
  set(std::span(&box, 1));
  RenderSettings settings;
  settings.indirect = Indirect::kOff;  // clouds are black
  settings.clouds.file_density = 1.0f;
  shared::Light lamp{};
  lamp.range = 8.0f;
  lamp.intensity = glm::vec3(5.0f);
  lamp.kind = shared::kLightPoint;
  lamp.position = {1.0f, 0.5f, 3.0f};
  lamp.axis = {0.0f, 1.0f, 0.0f};
  // A frame of many lights that reach everywhere leaves its clusters in memory that the next uses.
  std::vector<shared::Light> many(200, lamp);
  for (shared::Light& light : many) light.range = 400.0f;
  input.lights = many;
  radiance(input, settings);
  input.lights = std::span(&lamp, 1);
  const std::vector<glm::vec4> seen = radiance(input, settings);
  settings.lights_oracle = true;
  EXPECT_EQ(radiance(input, settings), seen);
}

TEST_F(CloudsOnGpu, TheLayerMovesWithTheWorldAndTimeAlone) {
  FrameInput input;
  input.sky = sun_at(40.0, 100.0);
  input.camera = camera_at({3.25, 90.0, -7.5}, 30.0, 20.0, 70.0);
  RenderSettings settings;
  settings.clouds.coverage = 0.7f;
  drawn(input, settings, kSize);
  const std::vector<std::uint8_t> here = picture();
  for (const std::int64_t far : {std::int64_t{1} << 40, -(std::int64_t{1} << 40) + 12345}) {
    FrameInput moved = input;
    for (int axis = 0; axis < 3; ++axis) {
      moved.camera.position[axis] += far * 65536;
      moved.anchor[axis] += far * 65536;
    }
    drawn(moved, settings, kSize);
    EXPECT_EQ(picture(), here) << far;
  }
  input.time_s = 60.0;
  drawn(input, settings, kSize);
  EXPECT_NE(picture(), here);
  // After a time in which each axis drifts whole periods.
  input.time_s = 10240.0;
  drawn(input, settings, kSize);
  EXPECT_EQ(picture(), here);
}

TEST_F(CloudsOnGpu, AFrameWithoutCloudsHasNoneOfTheirPassesAndImages) {
  FrameInput input;
  input.sky = sun_at(40.0, 100.0);
  RenderSettings settings;
  drawn(input, settings, kSize);
  EXPECT_FALSE(has_pass("cloud"));
  for (const gpu::MemoryUse& use : device().memory_use())
    EXPECT_EQ(use.name.find("cloud"), std::string::npos) << use.name;
  settings.clouds.coverage = 0.3f;
  drawn(input, settings, kSize);
  EXPECT_TRUE(has_pass("march_clouds"));
}

}  // namespace
}  // namespace skerry::render
