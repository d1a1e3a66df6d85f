#pragma once
#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/render/air/air.h"
#include "engine/render/air/light_moments.h"

namespace skerry::render {

/// What the sea of mist reflects, linear RGB: a Lambertian surface.
inline constexpr glm::dvec3 kMistAlbedo{0.22, 0.32, 0.44};

struct AtmosphereSettings {
  double turbidity = kTurbidity;  ///< 1..10
  glm::dvec3 ground_albedo = kMistAlbedo;
  /// Of the harmonics of light that has been scattered, 0..kLightDegree: `skerry report sky_tables`
  /// says what each is worth.
  int degree = kLightDegree;
};

/// The air about a sphere, lit from one side, as tables. Deterministic.
/// Sources: S. Hillaire, A Scalable and Production Ready Sky and Atmosphere Rendering Technique,
/// EGSR 2020, for the tables; in place of his even multiple scattering, orders of scattering are
/// integrated with harmonics of kLightDegree (decision 0052), and the forward peak of aerosol
/// counts as light that goes straight on (T. Nakajima, M. Tanaka, Algorithms for Radiative
/// Intensity Calculations, JQSRT 1988).
/// Heights are above the mist [km], from 0 (lower counts as 0) to any; sines are those of
/// elevations.
class Atmosphere {
 public:
  /// Some 100 ms. Asserts what Air does.
  explicit Atmosphere(const AtmosphereSettings& settings = {});

  const Air& air() const { return air_; }
  const AtmosphereSettings& settings() const { return settings_; }
  /// Transmittance from a place to space. A ray that meets the ground gets that of the horizon.
  glm::dvec3 transmittance(double height_km, double sine) const;
  /// Light of a body of irradiance 1 on a surface facing it: the transmittance, times the part of
  /// a disc of 0.53 degrees that stands above the horizon.
  glm::dvec3 direct_light(double height_km, double sine) const;
  /// The same with what aerosol has scattered ahead: what further scattering is made of.
  glm::dvec3 scattering_light(double height_km, double sine) const;
  /// What a step of a path sends to its eye of light that has been scattered before.
  StepLight scattered_again(const AirStep& step) const {
    return {moments_, step, settings_.degree};
  }
  /// Radiance of the ground under a body of irradiance 1 at this elevation, seen close by.
  glm::dvec3 ground(double sine) const;

  static constexpr int kTransmittanceSines = 128, kTransmittanceHeights = 40;

 private:
  friend class AtmosphereMaker;
  using OnGround = std::array<glm::dvec3, kMomentSines>;

  AtmosphereSettings settings_;
  Air air_;
  std::vector<glm::vec3> transmittance_;  ///< [height][sine]
  std::vector<glm::vec3> dimming_;        ///< likewise, by AirSample::dimming
  MomentTable moments_;                   ///< of all orders
  OnGround sky_on_ground_{};              ///< irradiance by the sine of the body's elevation
};

/// The world's atmosphere. Made by the first call, from any thread.
const Atmosphere& world_atmosphere();

}  // namespace skerry::render
