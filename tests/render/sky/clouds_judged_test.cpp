// Clouds of the GPU where they meet lamps, walls and water, judged by the reference renderer.
#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/render/air/atmosphere.h"
#include "engine/render/sky/sky_model.h"
#include "tests/render/renderer_on_gpu.h"
#include "tools/reference/reference.h"
#include "world/mesh/occupancy.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{48, 32};
constexpr int kEdge = 32;  // samples of a box of fog

class CloudsJudged : public RendererOnGpu {
 protected:
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  const std::vector<std::uint32_t> first_island_{0};

  /// Chunks about the lattice's origin: what is drawn, what blocks light, and the reference's.
  void build(const BlockAt& block_at) {
    add(block_at, {-1, -1, -1}, {1, 1, 1});
    add_occupancy(block_at, {-1, -1, -1}, {1, 1, 1});
    scene_.islands = {
        {world::Volume::from_voxels({-64, -64, -64}, {64, 64, 64}, [block_at](world::IVec3 v) {
          return block_at(v.x, v.y, v.z);
        })}};
  }

  void look_from(glm::dvec3 eye, double pitch_deg, double fov_deg) {
    input_.islands = islands_;
    input_.camera = camera_at(eye, 0.0, pitch_deg, fov_deg);
    const Axes axes = axes_of(input_.camera);
    scene_.view = {axes.right,  axes.up,     axes.forward, std::tan(fov_deg * M_PI / 360.0),
                   kSize.width, kSize.height};
    scene_.islands[0].origin = -eye;
  }

  /// A box of kEdge^3 samples of 1. @param density extinction [1/block].
  void fog(glm::dvec3 corner, glm::dvec3 extent, double density) {
    CloudVolumeDesc box;
    box.blocks_from_index =
        glm::scale(glm::translate(glm::dmat4(1.0), corner), extent / static_cast<double>(kEdge));
    box.tiles.push_back({{0, 0, 0}, kEdge, 1.0f});
    const Result<void> done = renderer().set_clouds(std::span(&box, 1), CloudPrecision::k32);
    ASSERT_TRUE(done) << done.error().message;
    settings_.clouds.file_density = static_cast<float>(density);
    reference::CloudGrid grid;
    grid.index_from_world = glm::inverse(box.blocks_from_index) *
                            glm::translate(glm::dmat4(1.0), blocks_at(input_.camera.position));
    grid.size = glm::ivec3(kEdge);
    grid.samples.assign(static_cast<std::size_t>(kEdge * kEdge * kEdge), 1.0f);
    grid.extinction = density;
    grid.step = 0.5 * std::min({extent.x, extent.y, extent.z}) / kEdge;
    scene_.clouds.grids = {grid};
  }

  void lamp(glm::dvec3 place, float intensity) {
    lamp_ = {};
    lamp_.kind = shared::kLightPoint;
    lamp_.position = glm::vec3(place - blocks_at(input_.camera.position));
    lamp_.range = 60.0f;
    lamp_.intensity = glm::vec3(intensity);
    lamp_.axis = {0.0f, 1.0f, 0.0f};
    lamp_.island_count = 1;
    input_.lights = std::span(&lamp_, 1);
    input_.light_islands = first_island_;
    scene_.lights = {reference::light_from(lamp_)};
  }

  std::vector<glm::vec4> seen() { return radiance(input_, settings_, kSize); }
  std::vector<glm::vec3> exact(std::uint32_t samples) {
    reference::ReferenceSettings settings;
    settings.samples = samples;
    settings.filter = game::ReferenceFilter::kCentre;
    return reference::render(scene_, settings).radiance.pixels;
  }

  FrameInput input_;
  RenderSettings settings_;
  reference::Scene scene_;
  shared::Light lamp_{};
};

/// A sky that gives no light.
Celestial night() {
  Celestial sky = celestial_at(0.0, 0.0);
  sky.sun_casts = sky.moon_casts = false;
  sky.sun_irradiance = sky.moon_irradiance = glm::vec3(0.0f);
  return sky;
}

/// A wall across the view, with a window or without.
BlockAt wall(bool window) {
  return [window](int x, int y, int z) -> world::BlockId {
    const bool open = window && x >= 2 && x < 5 && y >= 0 && y < 3;
    return z == 14 && !open ? world::block::kStone : world::block::kAirBlock;
  };
}

TEST_F(CloudsJudged, NoLightOfALampBehindAWallIsInTheFogBeforeIt) {
  build(wall(false));
  look_from({0.5, 0.5, 0.5}, 0.0, 60.0);
  input_.sky = night();
  fog({-20.0, -20.0, 4.0}, {40.0, 40.0, 9.5}, 0.02);
  lamp({2.0, 1.0, 17.5}, 40.0f);
  settings_.lights_shadows = 0;
  for (const glm::vec4& pixel : seen()) EXPECT_GT(pixel.y, 0.0f);
  for (const std::uint32_t traced : {1u, 4u, kEveryLight})
    for (const int resolution : {1, 2}) {
      settings_.lights_shadows = traced;
      settings_.clouds.resolution = resolution;
      for (const glm::vec4& pixel : seen()) EXPECT_EQ(glm::vec3(pixel), glm::vec3(0.0f)) << traced;
    }
}

TEST_F(CloudsJudged, LightThroughAWindowMakesTheBeamThatTheReferenceHas) {
  build(wall(true));
  look_from({0.5, 0.5, 0.5}, 0.0, 60.0);
  input_.sky = night();
  // Thin: the GPU dims light as if all of its way were in fog.
  fog({-20.0, -20.0, 4.0}, {40.0, 40.0, 9.5}, 0.001);
  lamp({3.5, 1.5, 20.0}, 4000.0f);
  settings_.lights_shadows = kEveryLight;
  settings_.clouds.resolution = 1;
  settings_.clouds.steps = 96;
  const std::vector<glm::vec4> gpu = seen();
  const std::vector<glm::vec3> truth = exact(256);
  double sum = 0.0, exact_sum = 0.0, off = 0.0, beside = 0.0;
  int dark = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    sum += static_cast<double>(gpu[i].y);
    exact_sum += static_cast<double>(truth[i].y);
    off += static_cast<double>(std::abs(gpu[i].y - truth[i].y));
    if (truth[i].y > 0.0f) continue;
    ++dark;
    beside += static_cast<double>(gpu[i].y);
  }
  EXPECT_GT(exact_sum, 0.0);
  EXPECT_GT(dark, 50) << "rays that the beam does not meet";
  EXPECT_NEAR(sum, exact_sum, 0.03 * exact_sum);
  EXPECT_LT(off, 0.12 * exact_sum);
  EXPECT_LT(beside, 1e-4 * exact_sum) << "no wider than a part of a step";
}

TEST_F(CloudsJudged, WaterMirrorsTheCloudsThatTheReferenceHas) {
  build([](int, int y, int) { return y < 0 ? world::block::kWater : world::block::kAirBlock; });
  look_from({0.5, 3.5, -50.5}, -14.0, 16.0);
  input_.sky = sun_at(40.0, 180.0);
  scene_.sky = reference::Sky{sky_model(input_.sky), glm::dmat3(input_.sky.sky_from_world)};
  scene_.bodies = {{input_.sky.to_sun, glm::dvec3(input_.sky.sun_irradiance), 0.00465}};
  scene_.air_light = 1.0;
  settings_.leave_out.add(Feature::kHaze);
  settings_.shadow_enabled = false;
  scene_.shadows = false;
  const std::vector<glm::vec4> clear = seen();
  const std::vector<glm::vec3> clear_truth = exact(64);
  // Half of the sky that is mirrored, and nowhere between eye and water.
  fog({-400.0, 80.0, 100.0}, {400.0, 60.0, 500.0}, 0.05);
  const std::vector<glm::vec4> gpu = seen();
  EXPECT_TRUE(has_pass("march_mirrored_clouds"));
  const std::vector<glm::vec3> truth = exact(64);
  // By squares of 8 pixels: one ray for four meets other ripples than each of them.
  struct Square {
    int water = 0;
    double gpu = 0.0, exact = 0.0;
  };
  std::array<Square, 24> squares{};
  for (std::uint32_t i = 0; i < truth.size(); ++i) {
    const std::uint32_t x = i % kSize.width, y = i / kSize.width;
    const glm::dvec3 ray = ray_of(input_.camera, x, y, kSize.width, kSize.height);
    if (-3.5 / ray.y * ray.z > 100.0) continue;  // past the pond
    Square& square = squares[y / 8 * 6 + x / 8];
    ++square.water;
    square.gpu += static_cast<double>(gpu[i].y - clear[i].y);
    square.exact += static_cast<double>(truth[i].y - clear_truth[i].y);
  }
  double off = 0.0, change = 0.0;
  int water = 0;
  for (const Square& square : squares) {
    water += square.water;
    change += std::abs(square.exact);
    off += std::abs(square.gpu - square.exact);
  }
  EXPECT_GT(water, 1000);
  EXPECT_GT(change / water, 1e-3) << "clouds show";
  EXPECT_LT(off, 0.25 * change) << "of what they change";
}

/// The sun below the horizon, so that the sky alone gives light.
Celestial blue_hour(double altitude_deg) {
  Celestial sky = sun_at(altitude_deg, 180.0);
  sky.sun_casts = false;
  sky.sun_irradiance = glm::vec3(0.0f);
  return sky;
}

TEST_F(CloudsJudged, InTheBlueHourCloudsHaveTheSkysLightThatTheReferenceHas) {
  build([](int, int, int) { return world::block::kAirBlock; });
  look_from({0.5, 0.5, 0.5}, 20.0, 40.0);
  settings_.leave_out.add(Feature::kHaze);
  settings_.clouds.resolution = 1;
  settings_.clouds.steps = 96;
  settings_.clouds.shadow_steps = 64;
  fog({-200.0, 40.0, 60.0}, {400.0, 100.0, 200.0}, 0.03);
  scene_.sky_lights = true;
  scene_.body_in_air = scene_.air_light = 0.0;
  // Lower, such light is a few of the least steps that a half has.
  for (const double altitude : {-2.0, -6.0}) {
    input_.sky = blue_hour(altitude);
    const SkyModel sky = sky_model(input_.sky);
    scene_.sky = reference::Sky{sky, glm::dmat3(input_.sky.sky_from_world)};
    scene_.sky->model.constants.stars = 0.0f;
    const std::vector<glm::vec4> gpu = seen();
    // The way to the zenith is traced once.
    EXPECT_EQ(has_pass("trace_cloud_volumes"), altitude == -2.0);
    const std::vector<glm::vec3> truth = exact(256);
    glm::dvec3 sum(0.0), exact_sum(0.0);
    for (std::uint32_t i = 0; i < truth.size(); ++i) {
      // Where there is next to nothing but cloud: what stars are behind it does not matter.
      const glm::dvec3 ray =
          ray_of(input_.camera, i % kSize.width, i / kSize.width, kSize.width, kSize.height);
      if (ray.y < 0.3) continue;
      sum += glm::dvec3(gpu[i]);
      exact_sum += glm::dvec3(truth[i]);
    }
    for (int c = 0; c < 3; ++c) {
      EXPECT_GT(exact_sum[c], 0.0);
      EXPECT_NEAR(sum[c] / exact_sum[c], 1.0, 0.06) << altitude;
    }
  }
}

TEST_F(CloudsJudged, CloudsDoNotJumpAsTheSunStopsGivingLight) {
  build([](int, int, int) { return world::block::kAirBlock; });
  look_from({0.5, 0.5, 0.5}, 20.0, 40.0);
  settings_.clouds.resolution = 1;
  fog({-200.0, 40.0, 60.0}, {400.0, 100.0, 200.0}, 0.03);
  glm::dvec3 before(0.0);
  // The disc is gone half its width below the true horizon, at -0.773 degrees.
  for (const double altitude : {-0.75, -0.76, -0.77, -0.78, -0.79}) {
    input_.sky = blue_hour(altitude);
    input_.sky.sun_irradiance = sunlight_in_space() * world_atmosphere().direct_light(
                                                          kWorldAboveMistKm, input_.sky.to_sun.y);
    input_.sky.sun_casts = input_.sky.sun_irradiance != glm::vec3(0.0f);
    EXPECT_EQ(input_.sky.sun_casts, altitude > -0.773);
    glm::dvec3 sum(0.0);
    for (const glm::vec4& pixel : seen()) sum += glm::dvec3(pixel);
    if (before != glm::dvec3(0.0)) {
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / before[c], 1.0, 0.02) << altitude;
    }
    before = sum;
  }
}

TEST_F(CloudsJudged, WithoutWaterInViewNothingIsMirrored) {
  build(wall(false));
  look_from({0.5, 0.5, 0.5}, 0.0, 60.0);
  input_.sky = sun_at(40.0, 180.0);
  settings_.clouds.coverage = 0.5f;
  seen();
  EXPECT_TRUE(has_pass("march_clouds"));
  EXPECT_FALSE(has_pass("mirrored"));
  for (const gpu::MemoryUse& use : device().memory_use())
    EXPECT_EQ(use.name.find("mirrored"), std::string::npos) << use.name;
}

}  // namespace
}  // namespace skerry::render
