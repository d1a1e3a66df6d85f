// Clouds that take a millionth of the light a step, and clouds that take all of it; the eye within;
// and clouds at the ends of the world.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/stage.h"

namespace skerry::tools::stability {
namespace {

constexpr VkExtent2D kCloudsSize{64, 48};
constexpr int kBoxEdge = 64;  // blocks and samples of the box
constexpr int kSteps = 96;
/// Short of the ends of the world by what the scene is large [blocks].
constexpr double kFarthest = 1099511627776.0 - 4096.0;

/// A box of samples of value 1, which linear ramps make as wide as `kBoxEdge` blocks exactly.
/// @param corner its first sample relative to `origin`.
render::CloudVolumeDesc box(const render::FixedPos& origin, glm::dvec3 corner) {
  render::CloudVolumeDesc out;
  out.origin = origin;
  out.blocks_from_index = glm::translate(glm::dmat4(1.0), corner + 0.5);
  out.tiles.push_back({{0, 0, 0}, kBoxEdge, 1.0f});
  return out;
}

/// The noon sky, which can be seen, but which lights nothing.
render::Celestial sky_without_light() {
  render::Celestial sky = sun_towards({0.0, 0.8, 0.6});
  sky.sun_irradiance = glm::vec3(0.0f);
  sky.sun_casts = false;
  return sky;
}

Result<Frame> look(gpu::Device& device, const render::FrameInput& in,
                   const render::RenderSettings& settings,
                   std::span<const render::CloudVolumeDesc> volumes) {
  auto stage = Stage::create(device);
  if (!stage) return stage.error();
  if (Result<void> ok = (*stage)->renderer().set_clouds(volumes, render::CloudPrecision::k32); !ok)
    return ok.error();
  return (*stage)->draw(in, settings, kCloudsSize);
}

/// @param depth of the box before the eye, straight ahead [blocks]; its sides are out of view.
Result<Rows> through(gpu::Device& device, double front, double depth, const std::string& what) {
  render::FrameInput in;
  in.camera = camera_at({0.0, 0.0, 0.0}, 0.0, 0.0, 15.0);
  in.sky = sky_without_light();
  in.capture = true;
  render::RenderSettings settings;
  settings.indirect = render::Indirect::kOff;  // clouds are black
  settings.clouds.resolution = 1;
  settings.clouds.steps = kSteps;
  const render::CloudVolumeDesc volume = box({}, {-kBoxEdge / 2, -kBoxEdge / 2, front});
  const auto clear = look(device, in, settings, {});
  if (!clear) return clear.error();
  const double step = kBoxEdge * std::sqrt(3.0) / kSteps;
  double off = 0.0, beyond = 0.0, darkest = 1.0;
  for (int decade = -6; decade <= 4; ++decade) {
    const double extinction = std::pow(10.0, decade) / step;
    settings.clouds.file_density = static_cast<float>(extinction);
    const auto frame = look(device, in, settings, std::span(&volume, 1));
    if (!frame) return frame.error();
    for (std::uint32_t i = 0; i < frame->radiance.size(); ++i) {
      const glm::dvec3 ray =
          ray_of(in.camera, kCloudsSize, i % kCloudsSize.width, i / kCloudsSize.width);
      const double exact = std::exp(-extinction * depth * glm::length(ray));
      for (int c = 0; c < 3; ++c) {
        const double share =
            static_cast<double>(frame->radiance[i][c]) / static_cast<double>(clear->radiance[i][c]);
        off = std::max(off, std::abs(share - exact));
        beyond += !(share >= 0.0 && share <= 1.0);
        darkest = std::min(darkest, share);
      }
    }
  }
  return Rows{{"error of transmittance, optical depth 1e-6 to 1e4 a step, " + what, 1e-3, off},
              {"transmittances below 0 or above 1, " + what, 0.0, if_shown(darkest < 0.5, beyond)}};
}

Result<Rows> before_the_eye(gpu::Device& device) {
  return through(device, 90.0, kBoxEdge, "box of 64 blocks");
}

Result<Rows> about_the_eye(gpu::Device& device) {
  return through(device, -kBoxEdge / 2, kBoxEdge / 2, "eye inside the box");
}

/// What so little cloud scatters that it does not shade itself is in proportion to it. Lit by a
/// moon from straight above, before a wall that it leaves black.
Result<Rows> faint_clouds(gpu::Device& device) {
  auto stage = Stage::create(device);
  if (!stage) return stage.error();
  const auto wall = [](int, int, int z) {
    return z >= 130 ? world::block::kStone : world::block::kAirBlock;
  };
  if (Result<void> added = (*stage)->add(wall, {-1, -1, 2}, {1, 1, 3}); !added)
    return added.error();
  const render::CloudVolumeDesc volume = box({}, {-kBoxEdge / 2, -kBoxEdge / 2, 30.0});
  if (Result<void> ok =
          (*stage)->renderer().set_clouds(std::span(&volume, 1), render::CloudPrecision::k32);
      !ok)
    return ok.error();
  render::FrameInput in;
  in.camera = camera_at({0.0, 0.0, 0.0}, 0.0, 0.0, 15.0);
  const std::vector<render::IslandPlacement> islands{{{}, {1.0, 0.0, 0.0, 0.0}, 300.0}};
  in.islands = islands;
  in.sky = moon_above(1e3f);
  in.capture = true;
  render::RenderSettings settings;
  settings.shadow_enabled = false;
  settings.leave_out.add(render::Feature::kHaze);
  settings.clouds.resolution = 1;
  settings.clouds.steps = kSteps;
  const double step = kBoxEdge * std::sqrt(3.0) / kSteps;
  double off = 0.0, dark = 0.0;
  std::vector<glm::vec3> faintest;
  for (int decade = -6; decade <= -4; ++decade) {
    settings.clouds.file_density = static_cast<float>(std::pow(10.0, decade) / step);
    const auto frame = (*stage)->draw(in, settings, kCloudsSize);
    if (!frame) return frame.error();
    if (faintest.empty()) {
      faintest = frame->radiance;
      for (const glm::vec3& seen : faintest) dark += std::min({seen.x, seen.y, seen.z}) <= 0.0f;
      continue;
    }
    for (std::size_t i = 0; i < faintest.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const double wanted = double{faintest[i][c]} * std::pow(10.0, decade + 6);
        off = std::max(off, std::abs(double{frame->radiance[i][c]} / wanted - 1.0));
      }
  }
  // At 1e-4 a step the box, 58 steps deep, shades itself by less than 2 * 58e-4; roundings of
  // halves besides.
  return Rows{{"relative error of light scattered, optical depth 1e-6 to 1e-4 a step, box",
               2.0 * 58e-4 + std::ldexp(1.0, -9), if_shown(dark == 0.0, off)},
              {"pixels of faint clouds that are black", 0.0, dark}};
}

/// Light, fire and every density together: nothing may be less than no light, or no number.
Result<Rows> lit(gpu::Device& device) {
  render::FrameInput in;
  in.camera = camera_at({0.0, 0.0, 0.0}, 0.0, 0.0, 70.0);
  in.capture = true;
  render::RenderSettings settings;
  settings.clouds.coverage = 1.0f;
  settings.clouds.altitude = -20.0;
  std::vector<render::CloudVolumeDesc> volumes(2, box({}, {-20.0, -20.0, 10.0}));
  volumes[1].role = render::CloudRole::kEmission;
  std::vector<std::uint8_t> without;
  double wrong = 0.0, changed = 0.0;
  for (const glm::dvec3 to_sun :
       {glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.6, 1e-6, 0.8)})
    for (const float density : {0.0f, 1e-6f, 1e-2f, 1e4f}) {
      in.sky = sun_towards(glm::normalize(to_sun));
      settings.clouds.density = settings.clouds.file_density = density;
      const auto frame = look(device, in, settings, volumes);
      if (!frame) return frame.error();
      wrong += non_finite_channels(frame->radiance) + frame->report.pixels.non_finite;
      for (const glm::vec3& c : frame->radiance) wrong += std::min({c.x, c.y, c.z}) < 0.0f;
      if (density == 0.0f) without = frame->rgba;
      changed += different_pixels(frame->rgba, without);
    }
  return Rows{{"channels that are negative or no number", 0.0, if_shown(changed > 0.0, wrong)}};
}

Result<Rows> far(gpu::Device& device) {
  render::FrameInput in;
  in.sky = sun_towards(glm::normalize(glm::dvec3(0.3, 0.5, 0.4)));
  in.camera = camera_at({12.25, 40.0, -7.0}, 20.0, 15.0, 70.0);
  in.time_s = 77.0;
  render::RenderSettings settings;
  settings.clouds.coverage = 0.6f;
  settings.clouds.altitude = 120.0;
  const auto at = [&](const glm::dvec3& offset) {
    render::FrameInput there = in;
    there.camera.position = moved(in.camera.position, offset);
    there.anchor = moved(in.anchor, offset);
    const render::CloudVolumeDesc volume = box(there.anchor, {10.0, 20.0, 60.0});
    return look(device, there, settings, std::span(&volume, 1));
  };
  const auto here = at({0.0, 0.0, 0.0});
  if (!here) return here.error();
  double different = 0.0;
  for (const double end : {1.0, -1.0}) {
    const auto there = at(glm::dvec3(end * kFarthest));
    if (!there) return there.error();
    different += different_pixels(here->rgba, there->rgba);
  }
  settings.clouds.coverage = 0.0f;
  const auto clear = look(device, in, settings, {});
  if (!clear) return clear.error();
  const bool shown = different_pixels(here->rgba, clear->rgba) > 0.0;
  return Rows{{"pixels that differ 2^40 blocks away", 0.0, if_shown(shown, different)}};
}

constexpr Case kCloudsCases[] = {{"clouds.box", before_the_eye},
                                 {"clouds.inside", about_the_eye},
                                 {"clouds.faint", faint_clouds},
                                 {"clouds.lit", lit},
                                 {"clouds.far", far}};

}  // namespace

std::span<const Case> cloud_cases() {
  return kCloudsCases;
}

}  // namespace skerry::tools::stability
