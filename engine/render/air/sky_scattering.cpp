#include "engine/render/air/sky_scattering.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>

#include "engine/render/air/air_path.h"

namespace skerry::render {
namespace {

constexpr double kHalfPi = std::numbers::pi / 2.0;
constexpr int kViewSteps = 24;

shared::SkyScatter scattering(const Atmosphere& atmosphere, const AirPath& path, double body_sine,
                              double body_flat) {
  const double cosine = path.sine * body_sine + path.flat * body_flat;
  glm::dvec3 rayleigh(0.0), mie(0.0), multiple(0.0);
  for (const AirStep& step : path.steps) {
    const double sine = step.body_sine(path, body_sine, body_flat);
    const glm::dvec3 light = atmosphere.scattering_light(step.height, sine);
    rayleigh += step.rayleigh * light;
    mie += step.mie * light;
    multiple += atmosphere.scattered_again(step, sine, cosine);
  }
  if (path.meets_ground)
    multiple += path.end * atmosphere.ground(path.ground_body_sine(body_sine, body_flat));
  // Harmonics of the second degree fall a little below 0 where there is all but no light.
  return {rayleigh, mie, glm::max(multiple, 0.0)};
}

}  // namespace

double sky_row_place(double elevation, double horizon) {
  const double from = elevation - horizon;
  const double range = from < 0.0 ? kHalfPi + horizon : kHalfPi - horizon;
  return 0.5 + 0.5 * std::copysign(std::sqrt(std::min(1.0, std::abs(from) / range)), from);
}

double sky_row_elevation(double place, double horizon) {
  const double root = 2.0 * place - 1.0;
  return horizon + root * std::abs(root) * (root < 0.0 ? kHalfPi + horizon : kHalfPi - horizon);
}

shared::SkyScatter sky_scattering_at(const Atmosphere& atmosphere, double height_km,
                                     double body_sine, double sine, double cos_azimuth) {
  const double flat = std::sqrt(std::max(0.0, 1.0 - body_sine * body_sine));
  return scattering(atmosphere, air_path(atmosphere.air(), height_km, sine, kViewSteps), body_sine,
                    flat * cos_azimuth);
}

SkyScattering sky_scattering(const Atmosphere& atmosphere, double height_km, double body_sine) {
  const double horizon = std::asin(horizon_sine(height_km));
  const double flat = std::sqrt(std::max(0.0, 1.0 - body_sine * body_sine));
  SkyScattering table;
  table.reserve(std::size_t{shared::kSkyLutHeight} * shared::kSkyAzimuths);
  for (std::uint32_t row = 0; row < shared::kSkyLutHeight; ++row) {
    const double elevation = sky_row_elevation(row / (shared::kSkyLutHeight - 1.0), horizon);
    const AirPath path = air_path(atmosphere.air(), height_km, std::sin(elevation), kViewSteps);
    for (std::uint32_t i = 0; i < shared::kSkyAzimuths; ++i) {
      const double azimuth = std::numbers::pi * i / (shared::kSkyAzimuths - 1.0);
      table.push_back(scattering(atmosphere, path, body_sine, flat * std::cos(azimuth)));
    }
  }
  return table;
}

}  // namespace skerry::render
