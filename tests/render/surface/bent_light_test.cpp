// Where the bed of a lake is seen, against Snell's law.
#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "engine/render/sky/sky_model.h"
#include "tests/render/extinction.h"
#include "tests/render/renderer_on_gpu.h"
#include "tools/reference/media.h"

namespace skerry::render {
namespace {

constexpr VkExtent2D kSize{121, 97};
constexpr double kDepth = 4.0, kEdge = 16.0;  // of the bed; where lamps end on it, along z

world::BlockId lake(int, int y, int z) {
  if (y >= 0) return world::block::kAirBlock;
  if (y >= -4) return world::block::kWater;
  return y == -5 && z < 16 ? world::block::kLamp : world::block::kStone;
}

class BentLight : public RendererOnGpu {
 protected:
  const std::vector<IslandPlacement> islands_{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};

  /// From so far that ripples turn no ray by more than a hundredth of a block.
  FrameInput view(double pitch_deg) const {
    const double pitch = glm::radians(pitch_deg);
    FrameInput in;
    in.islands = islands_;
    in.reach_blocks = 400.0;
    in.sky = celestial_at(0.0, 0.0);
    in.camera = camera_at({16.0, 120.0 * std::sin(pitch), kEdge - 120.0 * std::cos(pitch)}, 0.0,
                          -pitch_deg, 8.0);
    return in;
  }
};

/// Voxels are mirrored, and nothing but what is asked for gives light.
RenderSettings of_an_eye_in_water() {
  RenderSettings settings;
  settings.water_mirror = WaterMirror::kWorld;
  settings.indirect = Indirect::kOff;
  settings.leave_out.add(Feature::kHaze);
  return settings;
}

TEST_F(BentLight, ABedIsSeenWhereSnellsLawHasIt) {
  add(lake, {0, -1, 0}, {1, 0, 1});
  for (const double pitch : {25.0, 45.0, 70.0}) {
    const FrameInput in = view(pitch);
    const std::vector<glm::vec4> seen = radiance(in, {}, kSize);
    const glm::dvec3 eye(16.0, 120.0 * std::sin(glm::radians(pitch)),
                         kEdge - 120.0 * std::cos(glm::radians(pitch)));
    int lamps = 0, stones = 0;
    for (std::uint32_t y = 24; y < kSize.height - 24; ++y) {
      const std::uint32_t x = kSize.width / 2;
      const glm::dvec3 ray = glm::normalize(ray_of(in.camera, x, y, kSize.width, kSize.height));
      const double sine = std::hypot(ray.x, ray.z) / 1.333;
      const double surface = eye.z - eye.y / ray.y * ray.z;
      const double bed = surface + kDepth * sine / std::sqrt(1.0 - sine * sine);
      if (std::abs(bed - kEdge) < 0.3) continue;  // some pixels, and what ripples turn
      const bool lamp = bed < kEdge;
      EXPECT_EQ(seen[y * kSize.width + x].x > 0.2f, lamp)
          << pitch << " degrees, row " << y << ", " << bed << ": " << seen[y * kSize.width + x].x;
      ++(lamp ? lamps : stones);
    }
    EXPECT_GT(lamps, 5);
    EXPECT_GT(stones, 5);
  }
}

constexpr int kCeiling = 12, kCeilingEnd = 16;  // y, x
constexpr glm::dvec3 kInWater{32.0, -2.5, 32.0};

world::BlockId under_a_ceiling(int x, int y, int) {
  if (y == kCeiling && x < kCeilingEnd) return world::block::kStone;
  if (y >= 0) return world::block::kAirBlock;
  return y >= -4 ? world::block::kWater : world::block::kStone;
}

/// Where a ray of the eye in water meets the rippled surface.
struct SurfaceMet {
  double way;
  glm::dvec3 place, normal;  // towards the eye
};
SurfaceMet surface_met(glm::dvec3 ray) {
  const double way = -kInWater.y / ray.y;
  const glm::dvec3 place = kInWater + way * ray;
  const reference::Meeting surface{.t = way, .face = 2, .voxel = {}, .lattice = place};
  return {way, place, -reference::ripples_of(surface, 0.0)};
}

/// What an eye in water sees along a ray: the sky through the rippled surface, by Snell's,
/// Fresnel's and Beer's laws.
struct Above {
  bool near_an_edge = true;
  glm::dvec3 radiance{0.0};
};
Above seen_above(const SkyModel& sky, glm::dvec3 ray) {
  if (ray.y < 0.05) return {};
  constexpr double kIndex = 1.333;
  const SurfaceMet met = surface_met(ray);
  const glm::dvec3 p = met.place, normal = met.normal;
  const glm::dvec3 bent = glm::refract(ray, normal, kIndex);
  const double sine = kIndex * std::sqrt(1.0 - std::pow(glm::dot(ray, normal), 2.0));
  if (std::abs(sine - 1.0) < 0.03) return {};
  if (sine > 1.0) return {false, glm::dvec3(0.0)};
  const auto inside = [&](double height) {
    const glm::dvec3 high = p + bent * (height / bent.y);
    return std::min({high.x, kCeilingEnd - high.x, high.z, 64.0 - high.z});
  };
  const double below = inside(kCeiling), above = inside(kCeiling + 1);
  if (std::min(std::abs(below), std::abs(above)) < 0.7 || (below > 0.0) != (above > 0.0)) return {};
  if (below > 0.0) return {false, glm::dvec3(0.0)};
  const double upright = std::pow((kIndex - 1.0) / (kIndex + 1.0), 2.0);
  const double mirrored =
      upright + (1.0 - upright) * std::pow(1.0 - std::abs(glm::dot(bent, normal)), 5.0);
  // Radiance goes with the square of the index.
  return {false, kIndex * kIndex * (1.0 - mirrored) *
                     glm::exp(-met.way * extinction_of(world::block::kWater)) *
                     sky_radiance(bent, sky)};
}

TEST_F(BentLight, FromWaterTheSkyIsSeenWithinSnellsWindow) {
  add(under_a_ceiling, {0, -1, 0}, {1, 1, 1});
  add_occupancy(under_a_ceiling, {0, -1, 0}, {1, 1, 1});
  // Most that the bent rays meet is in the first picture, little in the last one.
  for (const double pitch : {40.0, 65.0, 85.0}) {
    FrameInput in;
    in.islands = islands_;
    in.sky = sun_at(40.0, 90.0);
    in.sky.sun_irradiance = glm::vec3(0.0f);
    in.camera = camera_at(kInWater, 270.0, pitch, 60.0);
    in.camera_medium = world::block::kWater;
    const std::vector<glm::vec4> seen = radiance(in, of_an_eye_in_water(), kSize);
    const SkyModel sky = sky_model(in.sky, kWorldAboveMistKm);
    int open = 0, closed = 0, wrong = 0;
    for (std::uint32_t y = 0; y < kSize.height; ++y) {
      for (std::uint32_t x = 0; x < kSize.width; ++x) {
        const Above above =
            seen_above(sky, glm::normalize(ray_of(in.camera, x, y, kSize.width, kSize.height)));
        if (above.near_an_edge) continue;
        const double blue = above.radiance.z;
        wrong +=
            std::abs(static_cast<double>(seen[y * kSize.width + x].z) - blue) > 0.06 * blue + 0.01;
        ++(blue > 0.0 ? open : closed);
      }
    }
    EXPECT_GT(open, 500) << pitch;
    EXPECT_GT(closed, 300) << pitch;
    EXPECT_LT(wrong, 0.002 * (open + closed)) << pitch;
  }
}

constexpr int kWall = 40, kLampsFrom = 28, kLampsTo = 36;  // x; z

world::BlockId before_a_wall(int x, int y, int z) {
  if (y >= 0) return world::block::kAirBlock;
  if (x >= kWall) {
    return z >= kLampsFrom && z < kLampsTo ? world::block::kLamp : world::block::kStone;
  }
  return y >= -4 ? world::block::kWater : world::block::kStone;
}

/// Where an eye in water meets the wall by a ray, in the water or mirrored by its surface.
struct MetWall {
  double way = 0.0, z = 0.0;
  bool mirrored = false, near_an_edge = true;
};
MetWall wall_met(glm::dvec3 ray) {
  if (ray.x < 0.1) return {};
  MetWall out;
  out.way = (kWall - kInWater.x) / ray.x;
  glm::dvec3 end = kInWater + out.way * ray;
  if (end.y > -0.2 && end.y < 0.2) return {};
  if (end.y > 0.0) {
    const SurfaceMet surface = surface_met(ray);
    if (1.333 * std::sqrt(1.0 - std::pow(glm::dot(ray, surface.normal), 2.0)) < 1.03) return {};
    const glm::dvec3 down = glm::reflect(ray, surface.normal);
    if (down.y > -0.05) return {};
    const double on = (kWall - surface.place.x) / down.x;
    end = surface.place + on * down;
    out.way = surface.way + on;
    out.mirrored = true;
  }
  out.z = end.z;
  out.near_an_edge =
      end.y < -3.7 || std::abs(end.z - kLampsFrom) < 0.3 || std::abs(end.z - kLampsTo) < 0.3;
  return out;
}

TEST_F(BentLight, WhatWaterMirrorsFromBelowIsAsThePictureShowsIt) {
  add(before_a_wall, {0, -1, 0}, {1, 1, 1});
  add_occupancy(before_a_wall, {0, -1, 0}, {1, 1, 1});
  FrameInput in;
  in.islands = islands_;
  in.sky = celestial_at(0.0, 0.0);
  in.camera = camera_at(kInWater, 90.0, 0.0, 60.0);
  in.camera_medium = world::block::kWater;
  const std::vector<glm::vec4> seen = radiance(in, of_an_eye_in_water(), kSize);
  const double taken = extinction_of(world::block::kWater).z;
  double sent[2] = {};  // by lamps in a block's way: seen straight, mirrored
  int lamps[2] = {}, stones = 0, wrong = 0;
  for (std::uint32_t y = 0; y < kSize.height; ++y) {
    for (std::uint32_t x = 0; x < kSize.width; ++x) {
      const MetWall met =
          wall_met(glm::normalize(ray_of(in.camera, x, y, kSize.width, kSize.height)));
      if (met.near_an_edge) continue;
      const double blue = seen[y * kSize.width + x].z * std::exp(taken * met.way);
      if (met.z >= kLampsFrom && met.z < kLampsTo) {
        sent[met.mirrored] += blue;
        ++lamps[met.mirrored];
      } else {
        wrong += blue > 0.02;
        ++stones;
      }
    }
  }
  ASSERT_GT(lamps[0], 500);
  ASSERT_GT(lamps[1], 300);
  EXPECT_GT(stones, 300);
  EXPECT_LT(wrong, 0.005 * stones);
  EXPECT_NEAR(sent[1] / lamps[1], sent[0] / lamps[0], 0.05 * sent[0] / lamps[0]);
}

}  // namespace
}  // namespace skerry::render
