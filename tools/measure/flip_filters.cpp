#include "tools/measure/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace skerry::measure {
namespace {

constexpr double kPi = std::numbers::pi;

/// One Gaussian of a contrast sensitivity function (the paper's table 1): `a` is its height in
/// frequency, `b` its width in space [degrees^2].
struct Gaussian {
  double a, b;
};

constexpr Gaussian kAchromatic{1.0, 0.0047};
constexpr Gaussian kRedGreen{1.0, 0.0053};
constexpr Gaussian kBlueYellow[] = {{34.1, 0.04}, {13.5, 0.025}};
constexpr double kWidest = 0.04;

/// Of a tap that counts, relative to the centre's.
constexpr double kLeastWeight = 1e-9;

/// Distance between the peaks of the feature detectors [degrees].
constexpr double kFeatureWidth = 0.082;

double sum_of(const Taps& taps) {
  double sum = taps.weights[0];
  for (std::size_t i = 1; i < taps.weights.size(); ++i) sum += 2.0 * taps.weights[i];
  return sum;
}

void scale(Taps& taps, double factor) {
  for (double& weight : taps.weights) weight *= factor;
}

SpatialFilter sum_of_gaussians(std::span<const Gaussian> gaussians, double pixels_per_degree) {
  // All three channels are cut off where the widest Gaussian has fallen to three deviations.
  const int radius =
      static_cast<int>(std::ceil(3.0 * std::sqrt(kWidest / (2.0 * kPi * kPi)) * pixels_per_degree));
  SpatialFilter made;
  double total = 0.0;
  for (const Gaussian& gaussian : gaussians) {
    SpatialFilter::Part part;
    for (int i = 0; i <= radius; ++i) {
      const double x = i / pixels_per_degree;
      const double weight = std::exp(-kPi * kPi * x * x / gaussian.b);
      if (weight < kLeastWeight) break;
      part.taps.weights.push_back(weight);
    }
    const double sum = sum_of(part.taps);
    scale(part.taps, 1.0 / sum);
    part.share = gaussian.a * std::sqrt(kPi / gaussian.b) * sum * sum;
    total += part.share;
    made.parts.push_back(std::move(part));
  }
  for (SpatialFilter::Part& part : made.parts) part.share /= total;
  return made;
}

}  // namespace

FlipFilters::FlipFilters(double pixels_per_degree)
    : achromatic(sum_of_gaussians({&kAchromatic, 1}, pixels_per_degree)),
      red_green(sum_of_gaussians({&kRedGreen, 1}, pixels_per_degree)),
      blue_yellow(sum_of_gaussians(kBlueYellow, pixels_per_degree)) {
  const double deviation = 0.5 * kFeatureWidth * pixels_per_degree;
  const int feature_radius = static_cast<int>(std::ceil(3.0 * deviation));
  edge.odd = true;
  double half = 0.0, positive = 0.0, negative = 0.0;
  for (int i = 0; i <= feature_radius; ++i) {
    const double gauss = std::exp(-i * i / (2.0 * deviation * deviation));
    smooth.weights.push_back(gauss);
    edge.weights.push_back(i * gauss);
    half += i * gauss;
    point.weights.push_back((i * i / (deviation * deviation) - 1.0) * gauss);
    const double both = (i == 0 ? 1.0 : 2.0) * point.weights.back();
    (both > 0.0 ? positive : negative) += both;
  }
  scale(smooth, 1.0 / sum_of(smooth));
  scale(edge, 1.0 / half);
  for (double& weight : point.weights) weight /= weight > 0.0 ? positive : -negative;
}

int FlipFilters::radius() const {
  int widest = smooth.radius();
  for (const SpatialFilter* filter : {&achromatic, &red_green, &blue_yellow})
    for (const SpatialFilter::Part& part : filter->parts)
      widest = std::max(widest, part.taps.radius());
  return widest;
}

}  // namespace skerry::measure
