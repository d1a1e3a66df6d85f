#include "engine/render/air/air.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/core/check.h"

namespace skerry::render {
namespace {

// At 680, 550 and 440 nm [1/km].
constexpr glm::dvec3 kRayleigh{5.802e-3, 13.558e-3, 33.1e-3};
constexpr glm::dvec3 kOzone{0.650e-3, 1.881e-3, 0.085e-3};
constexpr double kRayleighScaleKm = 8.0, kAerosolScaleKm = 1.2;
constexpr double kOzoneMiddleKm = 25.0, kOzoneHalfWidthKm = 15.0;
constexpr double kAerosolAlbedo = 0.9;  // of what aerosol takes away, the part that it scatters

}  // namespace

Air::Air(double turbidity) {
  SKERRY_ASSERT(turbidity >= 1.0 && turbidity <= 10.0);
  // Angstrom's beta by turbidity, exponent 1.3: optical depth of all aerosol overhead.
  const double beta = std::max(0.0, 0.04608 * turbidity - 0.04586);
  for (int i = 0; i < 3; ++i) {
    const double um = std::array{0.680, 0.550, 0.440}[static_cast<std::size_t>(i)];
    aerosol_[i] = beta * std::pow(um, -1.3) / kAerosolScaleKm;
  }
}

AirSample Air::at(double height_km) const {
  const double h = std::max(0.0, height_km);
  if (h > kAirDepthKm) return {};
  const double molecules = std::exp(-h / kRayleighScaleKm),
               aerosol = std::exp(-h / kAerosolScaleKm);
  const double ozone = std::max(0.0, 1.0 - std::abs(h - kOzoneMiddleKm) / kOzoneHalfWidthKm);
  AirSample sample;
  sample.rayleigh = kRayleigh * molecules;
  sample.mie = aerosol_ * (aerosol * kAerosolAlbedo);
  sample.extinction = sample.rayleigh + aerosol_ * aerosol + kOzone * ozone;
  sample.dimming = sample.extinction - kForward * sample.mie;
  return sample;
}

double rayleigh_phase(double cosine) {
  return 3.0 / (16.0 * std::numbers::pi) * (1.0 + cosine * cosine);
}

double mie_phase(double cosine) {
  constexpr double g2 = kMieG * kMieG;
  const double base = 1.0 + g2 - 2.0 * kMieG * cosine;
  return 3.0 / (8.0 * std::numbers::pi) * (1.0 - g2) / (2.0 + g2) * (1.0 + cosine * cosine) /
         (base * std::sqrt(base));
}

double horizon_sine(double height_km) {
  const double ratio = kMistRadiusKm / (kMistRadiusKm + std::max(0.0, height_km));
  return -std::sqrt(std::max(0.0, 1.0 - ratio * ratio));
}

}  // namespace skerry::render
