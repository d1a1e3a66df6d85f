// The sky by brute force: what the tables of engine/render/air are judged by. Written from the
// equations, with a code path of its own: single scattering by fine steps, all further orders by
// paths at random (delta tracking, Woodcock 1965, with light gathered at each collision).
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <random>

namespace skerry::reference {

/// The air of one wavelength. Lengths in km, from the middle of the sphere.
struct Gas {
  double rayleigh = 0.0, aerosol = 0.0, ozone = 0.0;  ///< extinction at the ground, ozone's most
  double albedo = 0.0;                                ///< of the ground
  static constexpr double kGround = 6360.0, kTop = 6460.0;

  double molecules(double h) const { return rayleigh * std::exp(-h / 8.0); }
  double haze(double h) const { return aerosol * std::exp(-h / 1.2); }
  double extinction(double h) const {
    return molecules(h) + haze(h) + ozone * std::max(0.0, 1.0 - std::abs(h - 25.0) / 15.0);
  }
};

/// Red, green or blue of table 1 of Hillaire 2020 with the aerosol of a turbidity.
Gas gas(int channel, double turbidity, glm::dvec3 ground);

/// Transmittance from a place to space; 0 if the ground is in the way.
double towards_sun(const Gas& air, glm::dvec3 place, glm::dvec3 sun);

/// Light scattered exactly once, and by the ground alone, of a sun of irradiance 1.
double scattered_once(const Gas& air, glm::dvec3 eye, glm::dvec3 dir, glm::dvec3 sun, int steps);

/// A mean of paths, and its standard error.
struct Estimate {
  double mean = 0.0, error = 0.0;
};

/// Light scattered more than once, ground included. Equal seeds give equal paths.
class AirPaths {
 public:
  AirPaths(const Gas& air, glm::dvec3 sun, unsigned seed) : air_(air), sun_(sun), random_(seed) {}
  Estimate more_than_once(glm::dvec3 eye, glm::dvec3 dir, int count);

 private:
  double even();
  /// A direction at an angle to another one.
  glm::dvec3 turned(glm::dvec3 from, double cosine);
  double rayleigh_cosine();
  double haze_cosine();
  double path(glm::dvec3 place, glm::dvec3 dir);

  Gas air_;
  glm::dvec3 sun_;
  std::mt19937 random_;
};

}  // namespace skerry::reference
