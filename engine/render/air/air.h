#pragma once
#include <glm/vec3.hpp>

#include "shaders/shared/sky.h"

namespace skerry::render {

/// Radius of the sea of mist, which is the ground of the atmosphere, and of the last air [km].
inline constexpr double kMistRadiusKm = 6360.0;
inline constexpr double kAirRadiusKm = 6460.0;
inline constexpr double kAirDepthKm = kAirRadiusKm - kMistRadiusKm;
/// Preetham's measure of haze: 1 is pure air. The world's own.
inline constexpr double kTurbidity = 1.5;

/// Coefficients of the air at one height [1/km], at the wavelengths that stand for red, green and
/// blue: 680, 550 and 440 nm.
struct AirSample {
  glm::dvec3 rayleigh{};    ///< scattering by molecules
  glm::dvec3 mie{};         ///< scattering by aerosol
  glm::dvec3 extinction{};  ///< scattering and absorption, ozone included
  glm::dvec3 dimming{};     ///< extinction less what kForward of the aerosol's scattering leaves
                            ///< about where it was
};

/// What the air is made of: molecules, aerosol and ozone.
/// Source: S. Hillaire, A Scalable and Production Ready Sky and Atmosphere Rendering Technique,
/// EGSR 2020, table 1; the aerosol follows the turbidity (Preetham, Shirley, Smits, A Practical
/// Analytic Model for Daylight, SIGGRAPH 1999, appendix A1).
class Air {
 public:
  /// Asserts 1 <= turbidity <= 10.
  explicit Air(double turbidity);
  /// @param height_km above the mist; below counts as 0.
  AirSample at(double height_km) const;

 private:
  glm::dvec3 aerosol_{};  ///< extinction at the ground [1/km]
};

/// Asymmetry of the aerosol's phase function.
inline constexpr double kMieG = 0.8;
static_assert(static_cast<float>(kMieG) == shared::kAerosolAsymmetry);
/// Part of what aerosol scatters that goes on about straight ahead, as good as not scattered at all
/// when light is scattered more than once (W. Wiscombe, The Delta-M Method, J. Atmos. Sci. 1977).
/// Chosen by paths at random: decision 0052.
inline constexpr double kForward = 0.05;
/// Phase functions of molecules and of aerosol (Cornette and Shanks 1992) by the cosine of the
/// angle between view and light [1/sr]; 1 looks into the light.
double rayleigh_phase(double cosine);
double mie_phase(double cosine);

/// Sine of the true horizon's elevation: 0 on the ground, negative above.
double horizon_sine(double height_km);

}  // namespace skerry::render
