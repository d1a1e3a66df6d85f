#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/mat3x3.hpp>

#include "engine/render/frame/display.h"
#include "tools/reference/reference.h"

namespace skerry::reference {
namespace {

/// ACES as S. Hill fits it (BakingLab, 2016): to the display transform's primaries, a rational
/// curve for the reference and output transforms, and back. The curve's constant of -0.000090537 is
/// left out, so that black stays black.
glm::dvec3 aces_fit(glm::dvec3 exposed) {
  // Rows as published; glm takes columns, so vectors multiply from the left.
  constexpr glm::dmat3 kInput{0.59719, 0.35458, 0.04823, 0.07600, 0.90834,
                              0.01566, 0.02840, 0.13383, 0.83777};
  constexpr glm::dmat3 kOutput{1.60475,  -0.53108, -0.07367, -0.10208, 1.10813,
                               -0.00605, -0.00327, -0.07276, 1.07602};
  const glm::dvec3 v = exposed * kInput;
  const glm::dvec3 curve = v * (v + 0.0245786) / (v * (0.983729 * v + 0.4329510) + 0.238081);
  return glm::clamp(curve * kOutput, 0.0, 1.0);
}

/// That fit, of light that is raised where its brightest channel is far below 0.05, is drawn
/// together where that is beyond 1.5, and keeps most of its ratios there: docs/exposure.md.
glm::dvec3 aces(glm::dvec3 exposed) {
  constexpr double kDark = 0.05, kBright = 1.5, kEnd = 12.0, kRatiosKept = 0.75;
  const double seen = std::max({exposed.x, exposed.y, exposed.z}) / kDark;
  exposed *= 1.0 + 2.0 / (1.0 + seen * seen);
  const double b = std::max({exposed.x, exposed.y, exposed.z});
  if (!(b > kBright)) return aces_fit(exposed);
  const double y = b / kBright - 1.0;
  const double u = 0.4 * y / (y + 2.88) + 0.6 * y / (y + 150.0), w = y / (y + 0.4);
  const glm::dvec3 ratios = exposed / b;
  const glm::dvec3 c = aces_fit(ratios * (kBright + (kEnd - kBright) * u));
  return glm::mix(c, ratios * std::max({c.x, c.y, c.z}), kRatiosKept * w);
}

/// AgX's curve as T. Sobotka words it in his generator (AgX.py, 2022): a hyperbola scaled so that
/// it passes through both ends and has a slope at its pivot. @param x 0..1.
double agx_sigmoid(double x) {
  constexpr double kPivotX = 10.0 / 16.5, kPivotY = 0.5, kSlope = 2.0;
  const bool above = x >= kPivotX;
  const double power = above ? 3.25 : 3.0, width = above ? 1.0 - kPivotX : kPivotX,
               height = above ? 1.0 - kPivotY : kPivotY;
  const double scale =
      std::pow(std::pow(kSlope * width, -power) * (std::pow(kSlope * width / height, power) - 1.0),
               -1.0 / power);
  const double term = kSlope * std::abs(x - kPivotX) / scale;
  const double way = scale * term / std::pow(1.0 + std::pow(term, power), 1.0 / power);
  return above ? kPivotY + way : kPivotY - way;
}

/// AgX with B. Wrensch's matrices for linear Rec. 709. @param exposed is shown at 0.6 of it, as
/// docs/exposure.md says.
glm::dvec3 agx(glm::dvec3 exposed) {
  constexpr glm::dmat3 kInset{0.842479062253094,  0.0784335999999992, 0.0792237451477643,
                              0.0423282422610123, 0.878468636469772,  0.0791661274605434,
                              0.0423756549057051, 0.0784336,          0.879142973793104};
  constexpr glm::dmat3 kOutset{1.19687900512017,    -0.0980208811401368, -0.0990297440797205,
                               -0.0528968517574562, 1.15190312990417,    -0.0989611768448433,
                               -0.0529716355144438, -0.0980434501171241, 1.15107367264116};
  const glm::dvec3 inset = (exposed * 0.6) * kInset;
  glm::dvec3 curve(0.0);
  for (int i = 0; i < 3; ++i) {
    const double x = (std::log2(inset[i]) + 12.47393) / 16.5;
    if (x > 0.0) curve[i] = agx_sigmoid(std::min(x, 1.0));
  }
  const glm::dvec3 c = glm::clamp(curve * kOutset, 0.0, 1.0);
  return {std::pow(c.x, 2.2), std::pow(c.y, 2.2), std::pow(c.z, 2.2)};
}

}  // namespace

glm::dvec3 tone_mapped(glm::dvec3 exposed, render::ToneCurve curve) {
  return curve == render::ToneCurve::kAgx ? agx(exposed) : aces(exposed);
}

std::vector<std::uint8_t> develop(const measure::Picture& radiance, double ev,
                                  const Darkroom& darkroom) {
  const double exposure = std::exp2(-ev);
  std::vector<std::uint8_t> out;
  out.reserve(radiance.pixels.size() * 4);
  measure::Picture glowing;
  if (darkroom.bloom.intensity > 0.0f) glowing = glow(radiance, ev, darkroom.bloom);
  for (std::size_t p = 0; p < radiance.pixels.size(); ++p) {
    glm::dvec3 exposed = glm::dvec3(radiance.pixels[p]) * exposure;
    if (!glowing.pixels.empty()) exposed += glm::dvec3(glowing.pixels[p]);
    const glm::dvec3 c = tone_mapped(exposed, darkroom.tone);
    for (int i = 0; i < 3; ++i)
      out.push_back(static_cast<std::uint8_t>(std::lround(
          std::clamp(render::displayed(render::srgb_encoded(c[i]), darkroom.display), 0.0, 1.0) *
          255.0)));
    out.push_back(255);
  }
  return out;
}

}  // namespace skerry::reference
