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

/// What an eye looks along: a path, and the light that its steps send.
class Look {
 public:
  Look(const Atmosphere& atmosphere, double height_km, double sine)
      : atmosphere_(atmosphere), path_(air_path(atmosphere.air(), height_km, sine, kViewSteps)) {
    again_.reserve(path_.steps.size());
    for (const AirStep& step : path_.steps) again_.push_back(atmosphere.scattered_again(step));
  }
  /// @param body_flat the body's horizontal part along the path's.
  shared::SkyScatter scattering(double body_sine, double body_flat);

 private:
  const Atmosphere& atmosphere_;
  AirPath path_;
  std::vector<StepLight> again_;
};

shared::SkyScatter Look::scattering(double body_sine, double body_flat) {
  const double cosine = path_.sine * body_sine + path_.flat * body_flat;
  glm::dvec3 rayleigh(0.0), mie(0.0), multiple(0.0);
  for (std::size_t i = 0; i < path_.steps.size(); ++i) {
    const AirStep& step = path_.steps[i];
    const double sine = step.body_sine(path_, body_sine, body_flat);
    const glm::dvec3 light = atmosphere_.scattering_light(step.height, sine);
    rayleigh += step.rayleigh * light;
    mie += step.mie * light;
    multiple += again_[i].at(sine, cosine);
  }
  if (path_.meets_ground)
    multiple += path_.end * atmosphere_.ground(path_.ground_body_sine(body_sine, body_flat));
  // Harmonics fall a little below 0 where there is all but no light.
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
  return Look(atmosphere, height_km, sine).scattering(body_sine, flat * cos_azimuth);
}

SkyScattering sky_scattering(const Atmosphere& atmosphere, double height_km, double body_sine) {
  const double horizon = std::asin(horizon_sine(height_km));
  const double flat = std::sqrt(std::max(0.0, 1.0 - body_sine * body_sine));
  SkyScattering table;
  table.reserve(std::size_t{shared::kSkyLutHeight} * shared::kSkyAzimuths);
  for (std::uint32_t row = 0; row < shared::kSkyLutHeight; ++row) {
    const double elevation = sky_row_elevation(row / (shared::kSkyLutHeight - 1.0), horizon);
    Look look(atmosphere, height_km, std::sin(elevation));
    for (std::uint32_t i = 0; i < shared::kSkyAzimuths; ++i) {
      const double azimuth = std::numbers::pi * i / (shared::kSkyAzimuths - 1.0);
      table.push_back(look.scattering(body_sine, flat * std::cos(azimuth)));
    }
  }
  return table;
}

}  // namespace skerry::render
