#pragma once
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace skerry::render {

/// Seconds in a day of the game.
inline constexpr double kDaySeconds = 86400.0;
/// Altitude of the noon sun above the southern horizon [degrees].
inline constexpr double kNoonAltitudeDeg = 60.0;
/// The axis about which the sky turns, unit: the celestial pole above the northern horizon. Sun and
/// moon keep at 90 degrees to it.
inline constexpr glm::dvec3 kCelestialPole{0.0, 0.5, -0.86602540378443864676};
/// Light of the full moon over light of the sun at the same altitude. The real ratio is 1/400,000,
/// which no display can follow.
inline constexpr double kMoonToSun = 1.0 / 400.0;

/// Where the two bodies stand and the light they send at one moment. Axes and units:
/// docs/conventions.md.
struct Celestial {
  glm::dvec3 to_sun, to_moon;  ///< unit
  glm::vec3 sun_irradiance;    ///< on a surface facing the sun, linear RGB, at the origin's height
  glm::vec3 moon_irradiance;   ///< on a surface facing the moon
  double moon_phase = 0.0;     ///< 0 new, 0.25 first quarter, 0.5 full, below 1
  float moon_lit_fraction = 0.0f;  ///< part of the disc that is lit, 0..1
  bool sun_casts = false;          ///< exactly when sun_irradiance is not zero
  bool moon_casts = false;         ///< exactly when moon_irradiance is not zero
  bool sun_exists = true;          ///< false: no disc and no glow of it either
  bool moon_exists = true;
  glm::mat3 sky_from_world;  ///< the frame in which the stars stand still: x at the sun, z at the
                             ///< celestial pole
};

/// The sky at a moment. The sun rises in the east at 06:00, culminates in the south at
/// kNoonAltitudeDeg and sets in the west at 18:00; the moon runs on the same circle, behind the sun
/// by the phase (full: opposite).
/// @param time_of_day_s any finite number of seconds, reduced exactly to a day; @param moon_phase
/// any finite number, reduced to 0..1. Asserts that both are finite. Irradiance:
/// sunlight_in_space() through the air (Atmosphere::direct_light) at the height of the world's
/// origin, from where the true horizon lies half a degree below 0: 0 below -0.8 degrees. The moon's
/// is kMoonToSun times that, times Lambert's phase law of a sphere, less 1% so that thin crescents
/// cast no light, times moon_beside_sun().
Celestial celestial_at(double time_of_day_s, double moon_phase);

/// The moon's light over the sun's at the same altitude, linear RGB, bluish. 0 about the new moon.
/// @param moon_phase 0..1.
glm::dvec3 moonlight(double moon_phase);

/// How much of the moon's light there is beside the sun's, 0..1: it fades out while the sun climbs
/// to 5.7 degrees, beside which it could not be seen.
double moon_beside_sun(double sun_sine);

/// Height of the world's origin above the sea of mist [km].
inline constexpr double kWorldAboveMistKm = 0.25;

/// Irradiance of the sun at the top of the air, linear RGB, so large that it is 3 at noon on the
/// islands.
glm::dvec3 sunlight_in_space();

}  // namespace skerry::render
