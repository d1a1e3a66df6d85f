#pragma once
#include <string>
#include <vector>

namespace skerry::measure {

/// Evenly spaced round numbers within [low, high], about `wanted` of them. @pre low < high.
std::vector<double> linear_ticks(double low, double high, int wanted);

/// Values to places along one side of a chart.
class ChartAxis {
 public:
  /// @param values what must be seen; finite, >= 0, not empty. @param from, to places of the axis's
  /// ends [pixels].
  ChartAxis(const std::vector<double>& values, double from, double to);

  double place(double value) const;
  bool logarithmic() const { return logarithmic_; }
  /// On a logarithmic axis of which some value is 0: it lies at `from`, apart from the rest.
  bool has_zero() const { return has_zero_; }
  const std::vector<double>& ticks() const { return ticks_; }

 private:
  double low_ = 0.0, high_ = 1.0, from_, to_;
  double start_;  // place of low_
  bool logarithmic_ = false, has_zero_ = false;
  std::vector<double> ticks_;
};

}  // namespace skerry::measure
