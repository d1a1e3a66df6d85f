#include "tools/measure/chart_axis.h"

#include <algorithm>
#include <cmath>

namespace skerry::measure {
namespace {

constexpr double kDecade = 10.0;    ///< from this ratio on, an axis is logarithmic
constexpr double kMargin = 0.06;    ///< share of the axis left free at its ends
constexpr double kZeroRoom = 34.0;  ///< between the line of 0 and a logarithmic axis [pixels]

}  // namespace

std::vector<double> linear_ticks(double low, double high, int wanted) {
  const double rough = (high - low) / wanted;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough) {
      step = factor * power;
      break;
    }
  std::vector<double> ticks;
  for (double n = std::ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; n += 1.0)
    ticks.push_back(n * step + 0.0);  // + 0: no tick says -0
  return ticks;
}

std::vector<double> log_ticks(double low, double high) {
  const double first = std::floor(std::log10(low)), last = std::ceil(std::log10(high));
  const bool many = last - first > 3.0;
  std::vector<double> ticks;
  for (double power = first; power <= last; power += 1.0)
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double tick = factor * std::pow(10.0, power);
      if (tick >= low && tick <= high && (factor == 1.0 || !many)) ticks.push_back(tick);
    }
  return ticks;
}

ChartAxis::ChartAxis(const std::vector<double>& values, double from, double to)
    : from_(from), to_(to), start_(from) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  high_ = *most;
  double least_positive = high_;
  for (const double value : values)
    if (value > 0.0) least_positive = std::min(least_positive, value);
  logarithmic_ = high_ > 0.0 && high_ / least_positive >= kDecade;
  if (logarithmic_) {
    has_zero_ = *least == 0.0;
    if (has_zero_) start_ += to_ > from_ ? kZeroRoom : -kZeroRoom;
    const double margin = std::pow(high_ / least_positive, kMargin);
    low_ = least_positive / margin;
    high_ *= margin;
    ticks_ = log_ticks(low_, high_);
    return;
  }
  // Near 0, a linear axis begins there, so that lengths compare.
  low_ = *least < 0.5 * high_ ? 0.0 : *least;
  if (high_ == low_) high_ = low_ > 0.0 ? 1.2 * low_ : 1.0;
  const double margin = kMargin * (high_ - low_);
  low_ = low_ == 0.0 ? 0.0 : low_ - margin;
  high_ += margin;
  ticks_ = linear_ticks(low_, high_, 6);
}

double ChartAxis::place(double value) const {
  if (!logarithmic_) return start_ + (to_ - start_) * (value - low_) / (high_ - low_);
  if (value <= 0.0) return from_;
  return start_ + (to_ - start_) * std::log(value / low_) / std::log(high_ / low_);
}

}  // namespace skerry::measure
