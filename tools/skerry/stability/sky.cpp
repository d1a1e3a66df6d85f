// A sun that passes the horizon, eyes far below and above the world, and air of every density.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/render/air/atmosphere.h"
#include "engine/render/air/sky_scattering.h"
#include "engine/render/sky/sky_model.h"
#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/directions.h"
#include "tools/skerry/stability/stage.h"

namespace skerry::tools::stability {
namespace {

using render::Atmosphere;
using render::Celestial;
using render::SkyModel;
using std::numbers::pi;

/// Without a moon.
Celestial sun_at_sine(double sine) {
  Celestial sky = render::celestial_at(12.0 * 3600.0, 0.0);
  sky.to_sun = glm::normalize(glm::dvec3(std::sqrt(1.0 - sine * sine), sine, 0.0));
  sky.moon_exists = false;
  return sky;
}

double sum_of(glm::dvec3 c) {
  return c.x + c.y + c.z;
}

/// The disc of 2 * 4.625e-3 rad rises by at most 1.5 of its mean speed (a smooth step), which
/// lights the air about the eye; as much again for what changes besides.
Result<Rows> sun_at_horizon() {
  double most = 0.0, light = 0.0;
  for (const double height_km : {0.25, 2.0, 10.0, 100.0}) {
    const SkyModel below = render::sky_model(sun_at_sine(-1e-6), height_km),
                   level = render::sky_model(sun_at_sine(0.0), height_km),
                   above = render::sky_model(sun_at_sine(1e-6), height_km);
    for (const glm::dvec3& d : even_directions(2000)) {
      const double middle = sum_of(render::sky_radiance(d, level));
      light += middle;
      for (const SkyModel* other : {&below, &above})
        most = std::max(most, std::abs(sum_of(render::sky_radiance(d, *other)) - middle) /
                                  std::max(middle, 1e-9));
    }
  }
  return Rows{{"relative change of the sky's light, sun 1e-6 rad beside the horizon",
               2.0 * 1.5 * 1e-6 / (2.0 * 4.625e-3), if_shown(light > 1.0, most)}};
}

int wrong_channels(const render::SkyScattering& table) {
  int wrong = 0;
  for (const shared::SkyScatter& s : table)
    for (const glm::vec3& part : {s.rayleigh, s.mie, s.multiple})
      for (int c = 0; c < 3; ++c) wrong += part[c] >= 0.0f && part[c] < 1e3f ? 0 : 1;
  return wrong;
}

float most_of(const render::SkyScattering& table) {
  float most = 0.0f;
  for (const shared::SkyScatter& s : table)
    most = std::max({most, s.rayleigh.x, s.rayleigh.z, s.multiple.y});
  return most;
}

/// Eyes 10 km below the world's origin to 1,000 km above, one below another above the last air.
Result<Rows> far_eyes() {
  constexpr double kBlocks[]{-1e4, -251.0, -250.0, 0.0, 1e3, 1e4, 9.97e4, 1e5, 3e5, 1e6};
  int wrong = 0, dark = 0;
  double below = 0.0;
  const auto sky_at = [](double sine, double blocks) {
    return render::sky_model(sun_at_sine(sine), render::eye_height_km(blocks));
  };
  for (const double sine : {-0.1, 0.0, 0.5, 1.0})
    for (const double blocks : kBlocks) {
      const SkyModel sky = sky_at(sine, blocks);
      if (!sky.scattering[0]) continue;
      wrong += wrong_channels(sky.scattering[0]->table);
      // Air or mist is seen from anywhere.
      dark += most_of(sky.scattering[0]->table) > 0.0f ? 0 : 1;
      for (const glm::dvec3& d : even_directions(200)) {
        const glm::dvec3 c = render::sky_radiance(d, sky);
        wrong += std::isfinite(sum_of(c)) && sum_of(c) >= 0.0 ? 0 : 1;
        if (blocks == -1e4)  // there is nothing below the mist
          below = std::max(below, glm::distance(c, render::sky_radiance(d, sky_at(sine, -251.0))));
      }
    }
  return Rows{{"channels negative or no number, eyes at -10 km to 1000 km", 0.0,
               static_cast<double>(wrong)},
              {"eyes at -10 km to 1000 km that see no light", 0.0, static_cast<double>(dark)},
              {"change of radiance from the mist's surface to -10 km", 0.0, below}};
}

/// What goes out of the air above over what comes in: a white ground, which takes nothing.
double light_out(const Atmosphere& air, double sun_sine) {
  constexpr double kHeightKm = 99.9;
  constexpr int kParts = 32;
  const double horizon = render::horizon_sine(kHeightKm);
  const double flat_sun = std::sqrt(1.0 - sun_sine * sun_sine);
  double out = 0.0;
  for (int i = 0; i < kParts; ++i)
    for (int j = 0; j < kParts; ++j) {
      const double sine = horizon - (1.0 + horizon) * (i + 0.5) / kParts;
      const double turn = pi * (j + 0.5) / kParts, flat = std::sqrt(1.0 - sine * sine);
      const double cosine = sine * sun_sine + flat * std::cos(turn) * flat_sun;
      const shared::SkyScatter s =
          render::sky_scattering_at(air, kHeightKm, sun_sine, sine, std::cos(turn));
      const glm::dvec3 radiance = glm::dvec3(s.rayleigh) * render::rayleigh_phase(cosine) +
                                  glm::dvec3(s.mie) * render::mie_phase(cosine) +
                                  glm::dvec3(s.multiple);
      out += radiance.y * -sine * 2.0 * pi * (1.0 + horizon) / (kParts * kParts);
    }
  return out / sun_sine;
}

Result<Rows> thin_and_thick_air() {
  int wrong = 0;
  double most = 0.0;
  for (const double turbidity : {1.0, 1.5, 10.0})
    for (const double albedo : {0.0, 1.0}) {
      const Atmosphere air({turbidity, glm::dvec3(albedo)});
      for (const double height_km : {0.0, 1e-3, 0.25, 10.0, 1000.0})
        for (const double sun_deg : {-90.0, -18.0, -1e-4, 1e-4, 45.0, 90.0})
          wrong += wrong_channels(
              render::sky_scattering(air, height_km, std::sin(sun_deg * pi / 180.0)));
      if (albedo == 1.0)
        for (const double sine : {0.3, 1.0}) most = std::max(most, light_out(air, sine));
    }
  return Rows{{"channels negative or no number, turbidity 1 to 10, ground black and white", 0.0,
               static_cast<double>(wrong)},
              {"light that leaves the air over light that comes, ground white", 1.0,
               if_shown(most > 0.5, most)}};
}

/// As drawn: the table's texels on the device, and what samples them.
Result<Rows> far_eyes_drawn(gpu::Device& device) {
  double wrong = 0.0, dark = 0.0;
  auto stage = Stage::create(device);
  if (!stage) return stage.error();
  render::RenderSettings settings;
  for (const double sine : {-0.05, -1e-6, 1e-6, 0.6})
    for (const double blocks : {-1e4, 0.0, 1e4, 1e6}) {
      render::FrameInput in;
      in.camera = camera_at({0.0, blocks, 0.0}, 0.0, -30.0, 120.0);
      in.sky = sun_at_sine(sine);
      in.capture = true;
      const auto frame = (*stage)->draw(in, settings, {64, 48});
      if (!frame) return frame.error();
      double light = 0.0;
      for (const glm::vec3& pixel : frame->radiance) {
        const double sum = sum_of(pixel);
        wrong += std::isfinite(sum) && sum >= 0.0 ? 0.0 : 1.0;
        light += sum;
      }
      wrong += static_cast<double>(frame->report.pixels.non_finite);
      dark += light > 0.0 ? 0.0 : 1.0;
    }
  return Rows{{"channels or pixels not finite, cameras at -10 km to 1000 km", 0.0, wrong},
              {"frames without light, cameras at -10 km to 1000 km", 0.0, dark}};
}

constexpr Case kSkyCases[] = {{"sky.horizon", sun_at_horizon},
                              {"sky.heights", far_eyes},
                              {"sky.air", thin_and_thick_air},
                              {"sky.cameras", far_eyes_drawn}};

}  // namespace

std::span<const Case> sky_cases() {
  return kSkyCases;
}

}  // namespace skerry::tools::stability
