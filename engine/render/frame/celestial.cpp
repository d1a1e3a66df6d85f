#include "engine/render/frame/celestial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "engine/core/check.h"
#include "engine/render/air/atmosphere.h"

namespace skerry::render {
namespace {

constexpr double kMoonFadesAtSine = 0.1;  // of the sun's altitude: 5.7 degrees
constexpr double kPi = std::numbers::pi;
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

/// Light reflected by a Lambertian sphere at elongation 2 pi * phase over that when full.
double lambert_phase(double phase) {
  const double alpha = std::abs(kPi - 2.0 * kPi * phase);  // angle sun, moon, eye
  return std::max(0.0, (std::sin(alpha) + (kPi - alpha) * std::cos(alpha)) / kPi);
}

glm::dvec3 direct_irradiance(double sine) {
  return sunlight_in_space() * world_atmosphere().direct_light(kWorldAboveMistKm, sine);
}

bool any(glm::vec3 v) {
  return v.x > 0.0f || v.y > 0.0f || v.z > 0.0f;
}

}  // namespace

glm::dvec3 moonlight(double moon_phase) {
  const double share = (lambert_phase(moon_phase) - kFaintestMoon) / (1.0 - kFaintestMoon);
  return kMoonToSun * std::max(0.0, share) * kMoonTint;
}

double moon_beside_sun(double sun_sine) {
  // By day moonlight is below 1/400 of what the sun gives and cannot be seen; fading it out saves
  // the moon's shadow maps and scattering.
  const double height = std::clamp(sun_sine / kMoonFadesAtSine, 0.0, 1.0);
  return 1.0 - height * height * (3.0 - 2.0 * height);
}

glm::dvec3 sunlight_in_space() {
  // What the noon sun gives: white, a little warm, and bright enough that a white surface which
  // faces it has a radiance of about 1.
  constexpr glm::dvec3 kNoon = kPi * glm::dvec3(0.974, 0.957, 0.933);
  static const glm::dvec3 kInSpace =
      kNoon / world_atmosphere().direct_light(kWorldAboveMistKm,
                                              std::sin(kNoonAltitudeDeg * (kPi / 180.0)));
  return kInSpace;
}

Celestial celestial_at(double time_of_day_s, double moon_phase) {
  const double turns = reduced(time_of_day_s, kDaySeconds) / kDaySeconds - 0.25;
  Celestial sky;
  sky.moon_phase = reduced(moon_phase, 1.0);
  sky.to_sun = on_equator(turns);
  sky.to_moon = on_equator(turns - sky.moon_phase);
  sky.moon_lit_fraction = static_cast<float>(0.5 * (1.0 - unit_circle(sky.moon_phase).x));
  sky.sun_irradiance = direct_irradiance(sky.to_sun.y);
  sky.moon_irradiance =
      moon_beside_sun(sky.to_sun.y) * moonlight(sky.moon_phase) * direct_irradiance(sky.to_moon.y);
  sky.sun_casts = any(sky.sun_irradiance);
  sky.moon_casts = any(sky.moon_irradiance);
  const glm::dmat3 rows(sky.to_sun, glm::cross(kCelestialPole, sky.to_sun), kCelestialPole);
  sky.sky_from_world = glm::transpose(rows);
  return sky;
}

}  // namespace skerry::render
