#pragma once
#include <cmath>

namespace skerry::water_laws {

/// Water's index, and what the laws of Snell, Fresnel (Schlick's form) and Beer say of level water.
/// Cosines are to the upright.
inline constexpr double kIndex = 1.333;

/// Share of light from the air that is mirrored.
inline double fresnel_at(double cosine) {
  const double upright = std::pow((kIndex - 1.0) / (kIndex + 1.0), 2.0);
  return upright + (1.0 - upright) * std::pow(1.0 - cosine, 5.0);
}
/// The same from within: all of it beyond the critical angle.
inline double fresnel_within(double cosine) {
  const double sine2 = kIndex * kIndex * (1.0 - cosine * cosine);
  return sine2 >= 1.0 ? 1.0 : fresnel_at(std::sqrt(1.0 - sine2));
}
/// In water, of what has this cosine in the air.
inline double bent_cosine(double cosine) {
  return std::sqrt(1.0 - (1.0 - cosine * cosine) / (kIndex * kIndex));
}

/// 2 times the integral of f(c) c over the cosine c.
template <class Fn>
double over_hemisphere(const Fn& f) {
  constexpr int kSteps = 4000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double cosine = (i + 0.5) / kSteps;
    sum += 2.0 / kSteps * cosine * f(cosine);
  }
  return sum;
}

/// Of an even sky's light, what comes down through so much optical depth.
inline double comes_down(double depth) {
  return over_hemisphere(
      [&](double c) { return (1.0 - fresnel_at(c)) * std::exp(-depth / bent_cosine(c)); });
}
/// Of what a wide bed sends up through so much optical depth, the part that comes back to it from
/// the surface.
inline double mirrored_back(double depth) {
  return over_hemisphere([&](double c) { return fresnel_within(c) * std::exp(-2.0 * depth / c); });
}

}  // namespace skerry::water_laws
