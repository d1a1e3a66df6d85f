#pragma once
#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "engine/render/air/air_path.h"

namespace skerry::render {

/// Degree of the harmonics in which light that has been scattered is kept.
inline constexpr int kLightDegree = 6;
inline constexpr std::size_t kLightDegrees = kLightDegree + 1;
inline constexpr std::size_t kLightTerms = kLightDegrees * (kLightDegrees + 1) / 2;

/// Place of degree l and order m, 0 <= m <= l, among a direction's harmonics.
constexpr std::size_t light_term(std::size_t l, std::size_t m) {
  return l * (l + 1) / 2 + m;
}

/// Moments of light by direction about a vertical plane that holds the body: real harmonics, z up,
/// x towards the body. Linear RGB; the fourth part makes vectors of four.
using LightMoments = std::array<glm::vec4, kLightTerms>;

/// The harmonics in a direction are the product of these: what depends on its elevation alone, by
/// term, and sin^m cos(m phi), by order. @param towards the direction's horizontal part along the
/// body's.
std::array<float, kLightTerms> elevation_harmonics(double sine);
std::array<float, kLightDegrees> azimuth_harmonics(double sine, double towards);

/// Aerosol's phase function without kForward, as far as harmonics of a degree show it [1/sr].
double smooth_mie_phase(double cosine, int degree);

/// The nodes at which moments are kept: sines of the body's elevation, finest about the horizon,
/// and heights [km], finest about the ground. Values between them are interpolated.
inline constexpr int kMomentSines = 40, kMomentHeights = 16;
double moment_sine(int node);
double moment_height(int node);

/// A place between the entries of a row.
struct Between {
  int first;
  double share;  ///< of the next one
};
/// @param place 0..1, clamped.
Between between(double place, int count);
Between between_sines(double sine);

/// [height][sine], kMomentHeights times kMomentSines.
using MomentTable = std::vector<LightMoments>;

/// What a step of a path sends to its eye of light that has been scattered before, for bodies in
/// any place: moments summed over their degrees once for a node of sines, which many bodies and
/// azimuths share. The table must outlive it. Not for several threads at once.
class StepLight {
 public:
  /// @param degree up to which the table is taken, at most kLightDegree.
  StepLight(const MomentTable& table, const AirStep& step, int degree);
  /// Of a body of irradiance 1. @param sine of the body's elevation over the step; @param cosine of
  /// the angle between body and path.
  glm::dvec3 at(double sine, double cosine);

 private:
  using Rounds = std::array<glm::vec4, kLightDegrees>;  ///< by the order m
  const Rounds& node(std::size_t sine);

  const LightMoments *low_, *high_;  ///< rows of the heights about the step
  float share_;                      ///< of the higher one
  double view_sine_;
  std::size_t degrees_;
  LightMoments weights_;  ///< what the step makes of each moment
  std::array<Rounds, kMomentSines> nodes_;
  std::array<bool, kMomentSines> known_{};
};

}  // namespace skerry::render
