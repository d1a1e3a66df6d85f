#pragma once
#include <vector>

namespace skerry::measure {

/// A filter along one axis that is even (w(-i) = w(i)) or odd (w(-i) = -w(i)).
struct Taps {
  bool odd = false;
  std::vector<double> weights;  ///< w(0), w(1) .. w(radius)

  int radius() const { return static_cast<int>(weights.size()) - 1; }
};

/// A round filter: a sum of separable ones, each `share` times taps(x) taps(y).
struct SpatialFilter {
  struct Part {
    double share = 0.0;
    Taps taps;  ///< sum to 1
  };
  std::vector<Part> parts;  ///< shares sum to 1
};

/// The filters of LDR-FLIP (P. Andersson et al., HPG 2020), for one viewing distance.
/// The contrast sensitivities of section 4.1.1 are sums of Gaussians of x^2 + y^2, and the feature
/// detectors of section 4.2.1 are derivatives of one: all of them separate exactly.
struct FlipFilters {
  SpatialFilter achromatic, red_green, blue_yellow;
  Taps smooth;  ///< sums to 1
  Taps edge;    ///< first derivative: the positive half sums to 1, the negative to -1
  Taps point;   ///< second derivative: positive weights sum to 1, negative ones to -1

  explicit FlipFilters(double pixels_per_degree);
  /// Of the widest filter [pixels].
  int radius() const;
};

/// Rows of numbers, side by side.
struct Plane {
  int width = 0, height = 0;
  std::vector<double> values;

  Plane(int w, int h) : width(w), height(h), values(static_cast<std::size_t>(w) * h) {}
  double* row(int y) { return values.data() + static_cast<std::size_t>(width) * y; }
  const double* row(int y) const { return values.data() + static_cast<std::size_t>(width) * y; }
};

/// Along x, the plane's first and last columns repeated beyond it.
Plane filter_rows(const Plane& in, const Taps& taps);
/// Along y. The result is 2 * margin rows lower: `margin` rows at each end only feed the filter.
/// @pre margin >= taps.radius().
Plane filter_columns(const Plane& in, const Taps& taps, int margin);
/// Both ways, parts summed.
Plane filter(const Plane& in, const SpatialFilter& spatial, int margin);

}  // namespace skerry::measure
