// The sun where it is hard to build shadow maps for, and motion too small to see.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/render/cascades.h"
#include "engine/render/celestial.h"
#include "tools/skerry/stability/case.h"

namespace skerry::tools::stability {
namespace {

using render::Cascade;
using render::CascadeInput;

/// Zenith, horizon, below, each axis both ways, the sky's poles, and a hair beside each.
std::vector<glm::dvec3> hard_directions() {
  std::vector<glm::dvec3> out;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      glm::dvec3 v{0.0};
      v[axis] = sign;
      out.push_back(v);
    }
  out.push_back(render::kCelestialPole);
  out.push_back(-render::kCelestialPole);
  out.push_back({0.6, 0.0, 0.8});     // exactly on the horizon, along no axis
  out.push_back({0.6, -0.001, 0.8});  // below it
  for (std::size_t i = 0, count = out.size(); i < count; ++i)
    for (const double hair : {1e-16, 1e-7})
      out.push_back(glm::normalize(out[i] + glm::dvec3(hair, -2.0 * hair, 0.5 * hair)));
  return out;
}

double non_finite_numbers(const Cascade& cascade) {
  double count = 0.0;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      count += !std::isfinite(cascade.clip_from_world[column][row]) +
               !std::isfinite(cascade.clip_from_centre[column][row]);
  for (const glm::vec4& plane : cascade.planes)
    for (int i = 0; i < 4; ++i) count += !std::isfinite(plane[i]);
  return count;
}

Result<Rows> directions() {
  double non_finite = 0.0, skew = 0.0, left_handed = 0.0;
  for (const glm::dvec3& to_light : hard_directions()) {
    const std::array<glm::dvec3, 3> axes = render::light_axes(to_light);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k <= i; ++k)
        skew = std::max(skew, std::abs(glm::dot(axes[static_cast<std::size_t>(i)],
                                                axes[static_cast<std::size_t>(k)]) -
                                       (i == k ? 1.0 : 0.0)));
    left_handed += glm::dot(glm::cross(axes[0], axes[1]), axes[2]) < 0.5;
    for (const std::int64_t far :
         {std::int64_t{0}, std::int64_t{1} << 56, -(std::int64_t{1} << 56)}) {
      CascadeInput in;
      in.to_light = to_light;
      in.camera = {far, far / 3, -far};
      for (const Cascade& cascade : render::make_cascades(in))
        non_finite += non_finite_numbers(cascade);
    }
  }
  // Rounding of three products and a normalisation each, and the right angle between a cross
  // product and its factors: eight half units in the last place of 1.
  const double rounding = 8.0 * std::ldexp(1.0, -53);
  return Rows{
      {"numbers that are not finite in cascades, sun at zenith, horizon, below, axes, poles", 0.0,
       non_finite},
      {"error of right angles and lengths of the light's axes", rounding, skew},
      {"left-handed axes", 0.0, left_handed}};
}

/// The sun's whole circle in a million places, at each a step of 1e-7 rad.
Result<Rows> continuity() {
  constexpr double kStep = 1e-7;
  const double seconds = kStep / (2.0 * std::numbers::pi) * render::kDaySeconds;
  double most = 0.0;
  constexpr int kPlaces = 1'000'000;
  for (int i = 0; i < kPlaces; ++i) {
    const double time_s = render::kDaySeconds * i / kPlaces;
    const auto before = render::light_axes(render::celestial_at(time_s, 0.5).to_sun);
    const auto after = render::light_axes(render::celestial_at(time_s + seconds, 0.5).to_sun);
    for (std::size_t axis = 0; axis < 3; ++axis)
      most = std::max(most, glm::distance(before[axis], after[axis]));
  }
  // The sun keeps at a right angle to the pole, so no axis turns faster than the sun; the time of
  // day is rounded to 2^-37 s (1e-15 rad), directions to a few 2^-53.
  return Rows{
      {"radians an axis of the light turns while the sun moves by 1e-7 rad", kStep + 4e-15, most}};
}

constexpr Case kCases[] = {{"shadows.directions", directions}, {"shadows.continuity", continuity}};

}  // namespace

std::span<const Case> shadows_cases() {
  return kCases;
}

}  // namespace skerry::tools::stability
