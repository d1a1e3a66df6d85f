#include "engine/render/air/air_path.h"

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>

namespace skerry::render {
namespace {

double body_sine_at(const AirPath& path, double along, double radius, double body_sine,
                    double body_flat) {
  const double toward = path.sine * body_sine + path.flat * body_flat;
  return std::clamp((path.eye * body_sine + along * toward) / radius, -1.0, 1.0);
}

/// (1 - exp(-depth)) / depth, as light is scattered evenly along a step of this depth.
double mean_transmittance(double depth, double left) {
  return depth > 1e-6 ? (1.0 - left) / depth : 1.0 - 0.5 * depth;
}

}  // namespace

double AirStep::body_sine(const AirPath& path, double body_sine, double body_flat) const {
  return body_sine_at(path, along, kMistRadiusKm + height, body_sine, body_flat);
}

double AirPath::ground_body_sine(double body_sine, double body_flat) const {
  return body_sine_at(*this, length, kMistRadiusKm, body_sine, body_flat);
}

AirPath air_path(const Air& air, double height_km, double sine, int steps) {
  AirPath path;
  path.eye = kMistRadiusKm + std::max(0.0, height_km);
  path.sine = sine;
  path.flat = std::sqrt(std::max(0.0, 1.0 - sine * sine));
  // The ray's distance from the middle is least at -eye * sine; squares as differences, which are
  // exact where they matter.
  const double middle = -path.eye * sine;
  const double nearest = path.eye * path.flat;
  const double to_top2 = (kAirRadiusKm - nearest) * (kAirRadiusKm + nearest);
  if (to_top2 <= 0.0 || (path.eye > kAirRadiusKm && middle < 0.0)) return path;
  const double half = std::sqrt(to_top2);
  const double first = std::max(0.0, middle - half);
  double last = std::max(first, middle + half);  // rounding
  path.meets_ground = sine < horizon_sine(height_km);
  if (path.meets_ground)
    // From the ground itself, 0 but for rounding.
    last = std::max(first, middle - std::sqrt(std::max(0.0, (kMistRadiusKm - nearest) *
                                                                (kMistRadiusKm + nearest))));
  path.length = last;
  path.steps.reserve(static_cast<std::size_t>(steps));
  double from = first;
  for (int i = 0; i < steps; ++i) {
    // Denser towards the ground: where such a ray ends, or where another one begins.
    const double s = (i + 1.0) / steps, other = 1.0 - s;
    const double to = first + (last - first) * (path.meets_ground ? 1.0 - other * other : s * s);
    const double length = to - from, along = 0.5 * (from + to);
    const double radius = std::sqrt(nearest * nearest + (along - middle) * (along - middle));
    const double height = std::max(0.0, radius - kMistRadiusKm);
    const AirSample here = air.at(height);
    const glm::dvec3 depth = here.dimming * length, left = glm::exp(-depth);
    glm::dvec3 weight;
    for (int c = 0; c < 3; ++c)
      weight[c] = path.end[c] * length * mean_transmittance(depth[c], left[c]);
    path.steps.push_back({height, along, std::clamp((along - middle) / radius, -1.0, 1.0),
                          weight * here.rayleigh, weight * here.mie});
    path.end *= left;
    from = to;
  }
  return path;
}

}  // namespace skerry::render
