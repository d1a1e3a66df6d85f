#include "engine/render/sky/sky_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>

#include "engine/render/light/cascades.h"

namespace skerry::render {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
constexpr double kTurbidity = 2.5;

double altitude_deg(double sine) {
  return std::asin(std::clamp(sine, -1.0, 1.0)) / kDegree;
}

double luminance(glm::dvec3 c) {
  return glm::dot(c, glm::dvec3{0.2126, 0.7152, 0.0722});
}

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// The Perez function of (Y, x, y). The chromaticities are looked up a little higher in the sky
/// near the horizon, where the paper's fit turns pink.
glm::dvec3 perez(const std::array<glm::dvec3, 5>& k, double cos_view, double gamma) {
  const double cos_gamma = std::cos(gamma), clear = 1.0 - cos_view;
  const double hue_view = cos_view + 0.25 * clear * clear * clear;
  const glm::dvec3 view{std::max(cos_view, 1e-3), hue_view, hue_view};
  return (1.0 + k[0] * glm::exp(k[1] / view)) *
         (1.0 + k[2] * glm::exp(k[3] * gamma) + k[4] * (cos_gamma * cos_gamma));
}

/// Preetham 1999, appendix A2: Perez coefficients A to E of (Y, x, y), linear in the turbidity.
std::array<glm::dvec3, 5> perez_terms() {
  constexpr double t = kTurbidity;
  return {glm::dvec3{0.1787 * t - 1.4630, -0.0193 * t - 0.2592, -0.0167 * t - 0.2608},
          glm::dvec3{-0.3554 * t + 0.4275, -0.0665 * t + 0.0008, -0.0950 * t + 0.0092},
          glm::dvec3{-0.0227 * t + 5.3251, -0.0004 * t + 0.2125, -0.0079 * t + 0.2102},
          glm::dvec3{0.1206 * t - 2.5771, -0.0641 * t - 0.8989, -0.0441 * t - 1.6537},
          glm::dvec3{-0.0670 * t + 0.3703, -0.0033 * t + 0.0452, -0.0109 * t + 0.0529}};
}

/// Preetham 1999, appendix A2: chromaticity of the zenith, cubic in the sun's angle from it.
glm::dvec2 zenith_chromaticity(double theta) {
  constexpr std::array<std::array<glm::dvec4, 3>, 2> kRows{
      {{glm::dvec4{0.00166, -0.00375, 0.00209, 0.0},
        glm::dvec4{-0.02903, 0.06377, -0.03202, 0.00394},
        glm::dvec4{0.11693, -0.21196, 0.06052, 0.25886}},
       {glm::dvec4{0.00275, -0.00610, 0.00317, 0.0},
        glm::dvec4{-0.04214, 0.08970, -0.04153, 0.00516},
        glm::dvec4{0.15346, -0.26756, 0.06670, 0.26688}}}};
  const glm::dvec4 powers{theta * theta * theta, theta * theta, theta, 1.0};
  const auto value = [&](const std::array<glm::dvec4, 3>& rows) {
    return glm::dot(rows[0], powers) * kTurbidity * kTurbidity +
           glm::dot(rows[1], powers) * kTurbidity + glm::dot(rows[2], powers);
  };
  return {value(kRows[0]), value(kRows[1])};
}

/// The paper's model under a body above 13 degrees. Its fit turns pale and brown under a lower one,
/// so from 13 down to -3 degrees a twilight takes over and carries on: a dome overhead, a band all
/// around the horizon and a fire about the body's azimuth. All follow zenith_radiance(), so they
/// fade smoothly and end at -18 degrees. About the horizon by day lies a bright haze, and what is
/// looked down into is lit by the same sky. These colours were chosen by eye, behind the tone
/// curve.
/// @param light the body's light over the sun's at the same altitude, linear RGB.
shared::SkyBody sky_body(glm::dvec3 to_body, glm::dvec3 light) {
  shared::SkyBody body;
  body.to_body = to_body;
  const std::array<glm::dvec3, 5> terms = perez_terms();
  body.perez_a = terms[0];
  body.perez_b = terms[1];
  body.perez_c = terms[2];
  body.perez_d = terms[3];
  body.perez_e = terms[4];
  const double h = altitude_deg(to_body.y);
  const double theta = (90.0 - std::max(0.0, h)) * kDegree;
  const double brightness = zenith_radiance(to_body.y);
  body.zenith = glm::dvec3(brightness, zenith_chromaticity(theta)) / perez(terms, 1.0, theta);
  const double dusk = 1.0 - smooth_step(-3.0, 13.0, h);
  const double late = 1.0 - smooth_step(-9.0, 1.0, h);
  const double low = 1.0 - smooth_step(0.0, 30.0, h);
  body.day = light * glm::mix(glm::dvec3{0.82, 0.98, 1.22}, glm::dvec3{0.86, 0.92, 1.42}, low) *
             (1.0 - dusk);
  body.haze = light * glm::mix(glm::dvec3{1.25, 1.95, 3.00}, glm::dvec3{1.85, 1.70, 1.95}, low) *
              (brightness * (1.0 - dusk));
  const auto hue = [&](glm::dvec3 sunset, glm::dvec3 after) {
    return light * glm::mix(sunset, after, late);
  };
  body.dusk_dome = hue({0.48, 0.78, 1.50}, {0.34, 0.62, 1.75}) * (brightness * dusk);
  body.dusk_band = hue({2.00, 1.10, 0.60}, {1.00, 0.70, 0.90}) * (brightness * dusk);
  body.dusk_fire = hue({5.60, 1.65, 0.10}, {4.60, 1.10, 0.12}) * (brightness * dusk);
  body.abyss = light * glm::mix(glm::dvec3{0.52, 1.02, 1.75}, glm::dvec3{0.36, 0.45, 0.85}, dusk) *
               brightness;
  return body;
}

glm::dvec3 linear_from_yxy(glm::dvec3 yxy) {
  const double s = yxy.x / std::max(yxy.z, 1e-3);
  const glm::dvec3 xyz{yxy.y * s, yxy.x, (1.0 - yxy.y - yxy.z) * s};
  return {3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
          -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
          0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z};
}

/// One body's radiance on the cone of sky at height `up` (sine of the elevation, >= 0). `dir` may
/// dip below it.
glm::dvec3 body_radiance(glm::dvec3 dir, double up, const shared::SkyBody& body) {
  const glm::dvec3 to_body(body.to_body);
  const double gamma = std::acos(std::clamp(glm::dot(dir, to_body), -1.0, 1.0));
  const std::array<glm::dvec3, 5> terms{body.perez_a, body.perez_b, body.perez_c, body.perez_d,
                                        body.perez_e};
  const glm::dvec3 yxy = glm::dvec3(body.zenith) * perez(terms, up, gamma);
  const glm::dvec3 day = glm::max(linear_from_yxy(yxy), 0.0) * glm::dvec3(body.day);
  const double low = std::pow(1.0 - up, 5.0);
  const double towards =
      (dir.x * to_body.x + dir.z * to_body.z) / std::max(1e-3, std::hypot(to_body.x, to_body.z));
  const double side = 0.5 + 0.5 * towards;
  const double rise = (dir.y - std::max(0.0, to_body.y)) / 0.11;
  const double fire = std::exp(4.0 * (towards - 1.0)) / (1.0 + rise * rise);
  const double band = std::exp(-5.0 * up) * (0.3 + 0.7 * side * side);
  const double dome = 0.75 + 0.75 * side * (1.0 - up);
  return glm::mix(day, glm::dvec3(body.haze), 0.9 * low) + fire * glm::dvec3(body.dusk_fire) +
         band * glm::dvec3(body.dusk_band) + dome * glm::dvec3(body.dusk_dome);
}

}  // namespace

shared::SkyConstants sky_constants(const Celestial& sky) {
  shared::SkyConstants c;
  c.sun = sky_body(sky.to_sun, glm::dvec3(sky.sun_exists ? 1.0 : 0.0));
  // Half of what the moon's light would give, and less blue: eyes see little colour then, and
  // moonlit land shall stand out from its sky.
  constexpr glm::dvec3 kMoonSky{0.62, 0.50, 0.42};
  c.moon = sky_body(sky.to_moon,
                    sky.moon_exists ? kMoonSky * moonlight(sky.moon_phase) : glm::dvec3(0.0));
  // A linear law's mean over the disc is 1 - u / 3: the darkened disc sends the sun's whole
  // irradiance.
  const glm::dvec3 limb(shared::kLimbRed, shared::kLimbGreen, shared::kLimbBlue);
  const double sine = std::sin(static_cast<double>(shared::kDiscRadius));
  c.sun_disc = transmittance_to_zenith(sky.to_sun.y) / (sine * sine * (1.0 - limb / 3.0));
  // By day the moon's ground is an eighth of white (its albedo); at night, as an eye would, it is
  // seen darker, or no display could show its face.
  const double night = 1.0 - smooth_step(-12.0, 2.0, altitude_deg(sky.to_sun.y));
  c.moon_disc = glm::mix(0.12, 0.013, night) * transmittance_to_zenith(sky.to_moon.y);
  if (!sky.sun_exists) c.sun_disc = glm::vec3(0.0f);
  if (!sky.moon_exists) c.moon_disc = glm::vec3(0.0f);
  const std::array<glm::dvec3, 3> sun = light_axes(sky.to_sun), moon = light_axes(sky.to_moon);
  c.sun_right = sun[0] / sine;
  c.sun_up = sun[1] / sine;
  c.moon_right = moon[0] / sine;
  c.moon_up = moon[1] / sine;
  c.moon_lit = glm::dvec3(glm::dot(moon[0], sky.to_sun), glm::dot(moon[1], sky.to_sun),
                          -glm::dot(sky.to_moon, sky.to_sun));
  const glm::mat3 rows = glm::transpose(sky.sky_from_world);
  c.sky_x = rows[0];
  c.sky_y = rows[1];
  c.sky_z = rows[2];
  // A risen full moon drowns two thirds of the stars' light.
  const double moonlit = luminance(sky.moon_irradiance) / (kMoonToSun * kPi);
  c.stars = static_cast<float>((1.0 - smooth_step(-13.0, -5.0, altitude_deg(sky.to_sun.y))) *
                               (1.0 - 0.66 * std::min(1.0, moonlit)));
  return c;
}

glm::dvec3 sky_radiance(glm::dvec3 dir, const shared::SkyConstants& sky) {
  const double up = std::max(0.0, dir.y);
  const glm::dvec3 radiance = body_radiance(dir, up, sky.sun) + body_radiance(dir, up, sky.moon);
  const double open = std::pow(std::min(1.0, 1.0 + dir.y), 4.0);
  return glm::mix(glm::dvec3(sky.sun.abyss + sky.moon.abyss), radiance, open);
}

float air_light(const Celestial& sky) {
  constexpr float kFullAt = 0.05f;
  const float sun = glm::dot(sky.sun_irradiance, glm::vec3(1.0f / 3.0f));
  const float moon =
      glm::dot(sky.moon_irradiance, glm::vec3(1.0f / 3.0f)) / static_cast<float>(kMoonToSun);
  return glm::smoothstep(0.0f, kFullAt, sky.sun_casts ? sun : moon);
}

}  // namespace skerry::render
