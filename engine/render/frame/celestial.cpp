#include "engine/render/frame/celestial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "engine/core/check.h"

namespace skerry::render {
namespace {

constexpr double kMoonFadesAtSine = 0.1;  // of the sun's altitude: 5.7 degrees
constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
constexpr double kTurbidity = 2.5;
constexpr double kHorizonHalfWidthDeg =
    0.3;                                // the disc (0.53 degrees) crosses the horizon within this
constexpr double kFaintestMoon = 0.01;  // share of the full moon's light below which it casts none
// Moonlight as eyes at night see it; unit luminance.
constexpr glm::dvec3 kMoonTint{0.79, 1.02, 1.42};

/// (cos, sin) of a fraction of a turn, exact at the quarters.
glm::dvec2 unit_circle(double turns) {
  const double quarter = std::floor(turns * 4.0 + 0.5);
  const double rest = (turns - quarter * 0.25) * (2.0 * kPi);
  const double c = std::cos(rest), s = std::sin(rest);
  switch (static_cast<int>(quarter) & 3) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

/// A place on the celestial equator: 0 turns east, a quarter the south at noon's altitude, half
/// west.
glm::dvec3 on_equator(double turns) {
  const glm::dvec2 p = unit_circle(turns);
  // The pole is (0, cos A, -sin A) for the noon altitude A, so the culmination is (0, sin A, cos
  // A).
  return glm::normalize(glm::dvec3(p.x, -p.y * kCelestialPole.z, p.y * kCelestialPole.y));
}

double reduced(double value, double period) {
  SKERRY_ASSERT(std::isfinite(value));
  const double rest = std::fmod(value, period);  // exact
  const double positive = rest < 0.0 ? rest + period : rest;
  return positive < period ? positive : 0.0;  // a tiny negative rest rounds up to the period
}

double altitude_deg(double sine) {
  return std::asin(std::clamp(sine, -1.0, 1.0)) / kDegree;
}

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Relative optical air mass, 1 at the zenith, 38 at the horizon. Kasten and Young 1989.
double air_mass(double altitude) {
  return 1.0 / (std::sin(altitude * kDegree) + 0.50572 * std::pow(altitude + 6.07995, -1.6364));
}

double visible_part(double sine) {
  return smooth_step(-kHorizonHalfWidthDeg, kHorizonHalfWidthDeg, altitude_deg(sine));
}

/// Light reflected by a Lambertian sphere at elongation 2 pi * phase over that when full.
double lambert_phase(double phase) {
  const double alpha = std::abs(kPi - 2.0 * kPi * phase);  // angle sun, moon, eye
  return std::max(0.0, (std::sin(alpha) + (kPi - alpha) * std::cos(alpha)) / kPi);
}

glm::dvec3 direct_irradiance(double sine) {
  return kPi * transmittance_to_zenith(sine) * visible_part(sine);
}

bool any(glm::vec3 v) {
  return v.x > 0.0f || v.y > 0.0f || v.z > 0.0f;
}

}  // namespace

glm::dvec3 moonlight(double moon_phase) {
  const double share = (lambert_phase(moon_phase) - kFaintestMoon) / (1.0 - kFaintestMoon);
  return kMoonToSun * std::max(0.0, share) * kMoonTint;
}

glm::dvec3 transmittance_to_zenith(double sine) {
  // Preetham 1999, appendix A1, at 680, 550 and 440 nm: optical depth of one air mass by molecules,
  // haze and ozone.
  constexpr glm::dvec3 kOzonePerCm{0.036, 0.085, 0.003};
  constexpr double kOzoneCm = 0.35;
  constexpr double kHaze = 0.04608 * kTurbidity - 0.04586;
  const double beyond_zenith = air_mass(std::max(0.0, altitude_deg(sine))) - air_mass(90.0);
  glm::dvec3 result;
  for (int i = 0; i < 3; ++i) {
    const double um = std::array{0.680, 0.550, 0.440}[static_cast<std::size_t>(i)];
    const double depth =
        0.008735 * std::pow(um, -4.08) + kHaze * std::pow(um, -1.3) + kOzonePerCm[i] * kOzoneCm;
    result[i] = std::exp(-depth * beyond_zenith);
  }
  return result;
}

double zenith_radiance(double sun_altitude_sine) {
  constexpr double kKilocandelas = 35.0;  // 110 klx of zenith sun over pi
  const double h = altitude_deg(sun_altitude_sine);
  const double chi = (4.0 / 9.0 - kTurbidity / 120.0) * 2.0 * std::max(0.0, h) * kDegree;
  const double day = (4.0453 * kTurbidity - 4.9710) * std::tan(chi) - 0.2155 * kTurbidity + 2.4192;
  constexpr double kSoftnessDeg = 1.5, kFallPerDeg = 0.45;
  const double depth = kSoftnessDeg * std::log1p(std::exp(-h / kSoftnessDeg));
  return day / kKilocandelas * std::exp(-kFallPerDeg * depth) * smooth_step(-18.0, -9.0, h);
}

Celestial celestial_at(double time_of_day_s, double moon_phase) {
  const double turns = reduced(time_of_day_s, kDaySeconds) / kDaySeconds - 0.25;
  Celestial sky;
  sky.moon_phase = reduced(moon_phase, 1.0);
  sky.to_sun = on_equator(turns);
  sky.to_moon = on_equator(turns - sky.moon_phase);
  sky.moon_lit_fraction = static_cast<float>(0.5 * (1.0 - unit_circle(sky.moon_phase).x));
  sky.sun_irradiance = direct_irradiance(sky.to_sun.y);
  // By day moonlight is below 1/400 of what the sun gives and cannot be seen; fading it out saves
  // the moon's shadow maps.
  const double sun_height = std::clamp(sky.to_sun.y / kMoonFadesAtSine, 0.0, 1.0);
  const double moon_left = 1.0 - sun_height * sun_height * (3.0 - 2.0 * sun_height);
  sky.moon_irradiance = moon_left * moonlight(sky.moon_phase) * direct_irradiance(sky.to_moon.y);
  sky.sun_casts = any(sky.sun_irradiance);
  sky.moon_casts = any(sky.moon_irradiance);
  const glm::dmat3 rows(sky.to_sun, glm::cross(kCelestialPole, sky.to_sun), kCelestialPole);
  sky.sky_from_world = glm::transpose(rows);
  return sky;
}

}  // namespace skerry::render
