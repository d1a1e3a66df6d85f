#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/mat3x3.hpp>

#include "tools/reference/reference.h"

namespace skerry::reference {
namespace {

/// ACES as S. Hill fits it (BakingLab, 2016): to the display transform's primaries, a rational
/// curve for the reference and output transforms, and back. The curve's constant of -0.000090537 is
/// left out, so that black stays black.
glm::dvec3 tone_mapped(glm::dvec3 exposed) {
  // Rows as published; glm takes columns, so vectors multiply from the left.
  constexpr glm::dmat3 kInput{0.59719, 0.35458, 0.04823, 0.07600, 0.90834,
                              0.01566, 0.02840, 0.13383, 0.83777};
  constexpr glm::dmat3 kOutput{1.60475,  -0.53108, -0.07367, -0.10208, 1.10813,
                               -0.00605, -0.00327, -0.07276, 1.07602};
  const glm::dvec3 v = exposed * kInput;
  const glm::dvec3 curve = v * (v + 0.0245786) / (v * (0.983729 * v + 0.4329510) + 0.238081);
  return glm::clamp(curve * kOutput, 0.0, 1.0);
}

/// IEC 61966-2-1.
std::uint8_t encoded(double linear) {
  const double srgb =
      linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(std::clamp(srgb, 0.0, 1.0) * 255.0));
}

}  // namespace

std::vector<std::uint8_t> develop(const measure::Picture& radiance, double ev) {
  const double exposure = std::exp2(-ev);
  std::vector<std::uint8_t> out;
  out.reserve(radiance.pixels.size() * 4);
  for (const glm::vec3& pixel : radiance.pixels) {
    const glm::dvec3 c = tone_mapped(glm::dvec3(pixel) * exposure);
    for (int i = 0; i < 3; ++i) out.push_back(encoded(c[i]));
    out.push_back(255);
  }
  return out;
}

}  // namespace skerry::reference
