#pragma once
#include <vector>

namespace skerry::measure {

/// A filter along one axis that is even (w(-i) = w(i)) or odd (w(-i) = -w(i)).
struct Taps {
  bool odd = false;
  std::vector<double> weights;  ///< w(0), w(1) .. w(radius)

  int radius() const { return static_cast<int>(weights.size()) - 1; }
};

/// A round filter: a sum of separable ones, each `share` times taps(x) taps(y). Taps of less than
/// 1e-9 of the centre are left out: they change no error by more than 1e-6.
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

}  // namespace skerry::measure
