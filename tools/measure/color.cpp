#include "tools/measure/color.h"

#include <cmath>
#include <glm/matrix.hpp>

namespace skerry::measure {
namespace {

/// Tristimulus values of a chromaticity at Y = 1.
glm::dvec3 xyz_of(double x, double y) {
  return {x / y, 1.0, (1.0 - x - y) / y};
}

/// XYZ over the white's XYZ, from linear Rec. 709: the primaries (ITU-R BT.709), scaled so that
/// they sum to the white, and each row divided by the white's value.
struct Matrices {
  glm::dmat3 relative_from_linear;
  glm::dmat3 linear_from_relative;

  Matrices() {
    const glm::dvec3 white = xyz_of(0.3127, 0.3290);
    const glm::dmat3 primaries(xyz_of(0.64, 0.33), xyz_of(0.30, 0.60), xyz_of(0.15, 0.06));
    const glm::dvec3 shares = glm::inverse(primaries) * white;
    for (int i = 0; i < 3; ++i) relative_from_linear[i] = primaries[i] * shares[i] / white;
    linear_from_relative = glm::inverse(relative_from_linear);
  }
};

const Matrices& matrices() {
  static const Matrices made;
  return made;
}

/// CIE's cube root with a linear part near zero.
double lab_curve(double t) {
  constexpr double kDelta = 6.0 / 29.0;
  if (t > kDelta * kDelta * kDelta) return std::cbrt(t);
  return t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
}

}  // namespace

const glm::dmat3& relative_from_linear() {
  return matrices().relative_from_linear;
}

const glm::dmat3& linear_from_relative() {
  return matrices().linear_from_relative;
}

double luminance(const glm::dvec3& linear) {
  const glm::dmat3& m = relative_from_linear();
  return m[0].y * linear.x + m[1].y * linear.y + m[2].y * linear.z;
}

glm::dvec3 ycxcz_from_linear(const glm::dvec3& linear) {
  const glm::dvec3 t = relative_from_linear() * linear;
  return {116.0 * t.y - 16.0, 500.0 * (t.x - t.y), 200.0 * (t.y - t.z)};
}

glm::dvec3 linear_from_ycxcz(const glm::dvec3& ycxcz) {
  const double y = (ycxcz.x + 16.0) / 116.0;
  return linear_from_relative() * glm::dvec3(y + ycxcz.y / 500.0, y, y - ycxcz.z / 200.0);
}

glm::dvec3 lab_from_linear(const glm::dvec3& linear) {
  const glm::dvec3 t = relative_from_linear() * linear;
  const double x = lab_curve(t.x), y = lab_curve(t.y), z = lab_curve(t.z);
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

double srgb_from_linear(double linear) {
  if (linear <= 0.0031308) return 12.92 * linear;
  return 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double linear_from_srgb(double srgb) {
  if (srgb <= 0.04045) return srgb / 12.92;
  return std::pow((srgb + 0.055) / 1.055, 2.4);
}

const std::array<float, 256>& linear_of_bytes() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> made{};
    for (std::size_t i = 0; i < made.size(); ++i)
      made[i] = static_cast<float>(linear_from_srgb(static_cast<double>(i) / 255.0));
    return made;
  }();
  return table;
}

}  // namespace skerry::measure
