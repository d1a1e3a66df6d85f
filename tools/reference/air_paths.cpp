#include "tools/reference/air_paths.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace skerry::reference {
namespace {

double phase_rayleigh(double c) {
  return 0.75 * (1.0 + c * c) / (4.0 * std::numbers::pi);
}
double phase_haze(double c) {
  constexpr double g = 0.8;
  return 1.5 * (1.0 - g * g) / (2.0 + g * g) * (1.0 + c * c) /
         std::pow(1.0 + g * g - 2.0 * g * c, 1.5) / (4.0 * std::numbers::pi);
}

/// Distance along a ray to a sphere about the middle from inside or outside; `far` the second
/// meeting. Negative: none ahead.
double to_sphere(glm::dvec3 from, glm::dvec3 dir, double radius, bool far) {
  const double b = glm::dot(from, dir), c = glm::dot(from, from) - radius * radius;
  const double disc = b * b - c;
  if (disc < 0.0) return -1.0;
  return far ? -b + std::sqrt(disc) : -b - std::sqrt(disc);
}

double height(glm::dvec3 p) {
  return std::max(0.0, glm::length(p) - Gas::kGround);
}

}  // namespace

Gas gas(int channel, double turbidity, glm::dvec3 ground) {
  constexpr double kUm[] = {0.680, 0.550, 0.440};
  constexpr double kMolecules[] = {5.802e-3, 13.558e-3, 33.1e-3};
  constexpr double kOzone[] = {0.650e-3, 1.881e-3, 0.085e-3};
  const double beta = std::max(0.0, 0.04608 * turbidity - 0.04586);
  return {kMolecules[channel], beta * std::pow(kUm[channel], -1.3) / 1.2, kOzone[channel],
          ground[channel]};
}

double towards_sun(const Gas& air, glm::dvec3 p, glm::dvec3 sun) {
  // A hair above, so that ground looks out of itself.
  if (to_sphere(p, sun, Gas::kGround - 1e-7, false) > 0.0) return 0.0;
  const double end = to_sphere(p, sun, Gas::kTop, true);
  // Simpson's rule in the cube root of the distance.
  constexpr int kParts = 48;
  double sum = 0.0;
  for (int i = 0; i <= kParts; ++i) {
    const double s = static_cast<double>(i) / kParts, t = end * s * s * s;
    const double weight = i == 0 || i == kParts ? 1.0 : i % 2 ? 4.0 : 2.0;
    sum += weight * air.extinction(height(p + sun * t)) * 3.0 * s * s * end;
  }
  return std::exp(-sum / (3.0 * kParts));
}

double scattered_once(const Gas& air, glm::dvec3 eye, glm::dvec3 dir, glm::dvec3 sun, int steps) {
  const double ground = to_sphere(eye, dir, Gas::kGround, false);
  const double top = to_sphere(eye, dir, Gas::kTop, true);
  if (top < 0.0) return 0.0;
  const double begin = std::max(0.0, to_sphere(eye, dir, Gas::kTop, false));
  const double end = ground > 0.0 ? ground : top;
  const double c = glm::dot(dir, sun);
  double sum = 0.0, depth = 0.0;
  for (int i = 0; i < steps; ++i) {
    // Two pieces, each finer towards the place that is nearest to the ground.
    const double low = std::clamp(-glm::dot(eye, dir), begin, end);
    const auto place = [&](double s) {
      return s < 0.5 ? low - (low - begin) * std::pow(1.0 - 2.0 * s, 2.0)
                     : low + (end - low) * std::pow(2.0 * s - 1.0, 2.0);
    };
    const double t0 = place(static_cast<double>(i) / steps), t1 = place((i + 1.0) / steps);
    const glm::dvec3 p = eye + dir * (0.5 * (t0 + t1));
    const double h = height(p), here = air.extinction(h) * (t1 - t0);
    const double scattered =
        air.molecules(h) * phase_rayleigh(c) + 0.9 * air.haze(h) * phase_haze(c);
    if (t1 > t0)
      sum += std::exp(-depth - 0.5 * here) * scattered * (t1 - t0) * towards_sun(air, p, sun);
    depth += here;
  }
  if (ground > 0.0) {
    const glm::dvec3 p = eye + dir * ground;
    sum += std::exp(-depth) * air.albedo / std::numbers::pi *
           std::max(0.0, glm::dot(p, sun) / glm::length(p)) * towards_sun(air, p, sun);
  }
  return sum;
}

Estimate AirPaths::more_than_once(glm::dvec3 eye, glm::dvec3 dir, int count) {
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < count; ++i) {
    const double one = path(eye, dir);
    sum += one;
    squares += one * one;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean) / count)};
}

double AirPaths::even() {
  return std::uniform_real_distribution<double>(0.0, 1.0)(random_);
}

glm::dvec3 AirPaths::turned(glm::dvec3 w, double c) {
  const glm::dvec3 u = glm::normalize(
      glm::cross(std::abs(w.x) > 0.5 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), w));
  const double phi = 2.0 * std::numbers::pi * even(), s = std::sqrt(std::max(0.0, 1.0 - c * c));
  return w * c + (u * std::cos(phi) + glm::cross(w, u) * std::sin(phi)) * s;
}

double AirPaths::rayleigh_cosine() {
  for (;;) {
    const double c = 2.0 * even() - 1.0;
    if (even() * 2.0 < 1.0 + c * c) return c;
  }
}

/// Henyey and Greenstein's, weighted to Cornette and Shanks' by rejection.
double AirPaths::haze_cosine() {
  constexpr double g = 0.8;
  for (;;) {
    const double q = (1.0 - g * g) / (1.0 - g + 2.0 * g * even());
    const double c = std::clamp((1.0 + g * g - q * q) / (2.0 * g), -1.0, 1.0);
    if (even() * 2.0 < 1.0 + c * c) return c;
  }
}

double AirPaths::path(glm::dvec3 p, glm::dvec3 dir) {
  double weight = 1.0, light = 0.0;
  for (int order = 1; order < 200; ++order) {
    const double ground = to_sphere(p, dir, Gas::kGround, false);
    const double top = to_sphere(p, dir, Gas::kTop, true);
    if (top <= 0.0) return light;
    double t = std::max(0.0, to_sphere(p, dir, Gas::kTop, false));
    const double end = ground > 1e-9 ? ground : top;
    // The thickest air of the ray is where it is lowest.
    const double lowest = height(p + dir * std::clamp(-glm::dot(p, dir), t, end));
    double most = 0.0;
    for (const double h : {lowest, std::max(lowest, 10.0), std::max(lowest, 25.0)})
      most = std::max(most, air_.extinction(h));
    bool hit = false;
    while (true) {
      t -= std::log(1.0 - even()) / most;
      if (t >= end) break;
      if (even() * most < air_.extinction(height(p + dir * t))) {
        hit = true;
        break;
      }
    }
    if (!hit && ground <= 1e-9) return light;
    p += dir * (hit ? t : ground);
    if (hit) {
      const double h = height(p), r = air_.molecules(h), m = 0.9 * air_.haze(h);
      weight *= (r + m) / air_.extinction(h);
      const double c = glm::dot(dir, sun_);
      if (order > 1)
        light += weight * (r * phase_rayleigh(c) + m * phase_haze(c)) / (r + m) *
                 towards_sun(air_, p, sun_);
      dir = turned(dir, even() * (r + m) < r ? rayleigh_cosine() : haze_cosine());
    } else {
      const glm::dvec3 up = glm::normalize(p);
      p = up * Gas::kGround;
      weight *= air_.albedo;
      const double sine = glm::dot(up, sun_);
      if (order > 1 && sine > 0.0)
        light += weight * sine / std::numbers::pi * towards_sun(air_, p, sun_);
      dir = turned(up, std::sqrt(even()));
      p += up * 1e-6;
    }
    if (weight < 0.1) {
      if (even() > weight * 5.0) return light;
      weight = 0.2;
    }
  }
  return light;
}

}  // namespace skerry::reference
