#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace skerry::measure {

/// How a point that is a default is marked.
enum class Mark : std::uint8_t { kGood, kDoubtful, kWrong };

/// One measured setting.
struct ChartPoint {
  std::string label;                                   ///< text
  double time = 0.0, time_low = 0.0, time_high = 0.0;  ///< finite, >= 0; low <= time <= high
  double error = 0.0;                                  ///< finite, >= 0
  std::vector<std::string> defaults;                   ///< quality levels whose default this is
  Mark mark = Mark::kGood;                             ///< of a default
};

/// Error against time. All strings are text.
struct Chart {
  std::string title, time_label, error_label;
  std::vector<ChartPoint> points;
};

/// The chart as a whole SVG document, light or dark as the reader's system is: points with their
/// spread in time, labels, the Pareto front as a staircase, defaults ringed. An axis is logarithmic
/// where its values span a decade or more; an error of 0 then has a line of its own at the bottom.
std::string svg_chart(const Chart& chart);

/// 1, 2 and 5 times powers of ten within [low, high]; powers of ten alone when those are many.
std::vector<double> log_ticks(double low, double high);

}  // namespace skerry::measure
