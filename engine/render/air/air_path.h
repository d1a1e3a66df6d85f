#pragma once
#include <vector>

#include "engine/render/air/air.h"

namespace skerry::render {

struct AirPath;

/// A piece of a ray through the air: what it scatters towards the eye of an even light of 1, less
/// what the air before it takes, by molecules and by aerosol.
struct AirStep {
  double height;     ///< of its middle [km]
  double along;      ///< from the eye to its middle [km]
  double view_sine;  ///< of the ray's elevation over its middle
  glm::dvec3 rayleigh, mie;

  /// Sine of the elevation of a body over its middle. @param body_sine over the eye; @param
  /// body_flat the body's horizontal part along the path's.
  double body_sine(const AirPath& path, double body_sine, double body_flat) const;
};

/// A ray through the air, for bodies in any place. Light is dimmed by AirSample::dimming.
struct AirPath {
  double eye = 0.0;               ///< distance from the middle of the sphere [km]
  double sine = 0.0, flat = 1.0;  ///< sine and cosine of the ray's elevation
  std::vector<AirStep> steps;     ///< none of a ray that passes above the air
  bool meets_ground = false;
  double length = 0.0;  ///< to the ground or the last air [km]
  glm::dvec3 end{1.0};  ///< transmittance of all of it

  /// Sine of a body's elevation over the ground that the ray meets.
  double ground_body_sine(double body_sine, double body_flat) const;
};

/// @param height_km of the eye, from 0; @param steps > 0.
AirPath air_path(const Air& air, double height_km, double sine, int steps);

}  // namespace skerry::render
