#include "tools/measure/chart.h"

#include "tools/measure/chart_axis.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/measure/xml.h"
#include "tools/measure/chart_axis.h"

namespace skerry::measure {
namespace {

Chart sweep(double error_factor) {
  Chart chart{"Shadow size", "GPU time [ms]", "FLIP", {}};
  double error = 0.2, time = 1.0;
  for (const char* label : {"256", "512", "1024", "2048", "4096"}) {
    chart.points.push_back({label, time, 0.9 * time, 1.2 * time, error, {}});
    error *= error_factor;
    time *= 1.5;
  }
  return chart;
}

std::size_t count(const std::string& text, std::string_view part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

TEST(Chart, IsWellFormedWhateverTheTextsAre) {
  Chart chart = sweep(0.5);
  const std::string hostile = "</text></svg><script>\"'&\x02\xff";
  chart.title = chart.time_label = chart.error_label = hostile;
  for (ChartPoint& point : chart.points) {
    point.label = hostile;
    point.defaults = {hostile};
  }
  const std::string svg = svg_chart(chart);
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_EQ(svg.find("<script"), std::string::npos);
}

TEST(Chart, ShowsEveryPointItsSpreadAndTheFront) {
  Chart chart = sweep(0.5);
  chart.points.push_back({"worse", 9.0, 9.0, 9.0, 0.5, {"low", "medium"}, Mark::kWrong});
  const std::string svg = svg_chart(chart);
  EXPECT_EQ(count(svg, "class=\"on\""), 5u);
  EXPECT_EQ(count(svg, "class=\"off\""), 1u);
  EXPECT_EQ(count(svg, "class=\"spread\""), 18u);
  EXPECT_EQ(count(svg, "class=\"front\""), 1u);
  EXPECT_EQ(count(svg, "class=\"wrong\""), 1u);
  EXPECT_EQ(count(svg, "default: low, medium (off the front)"), 1u);
  for (const ChartPoint& point : chart.points)
    EXPECT_EQ(count(svg, ">" + point.label + "<"), 1u) << point.label;
}

// As measured: medians of 1.81 to 1.84 ms, and a late frame at 12 ms.
TEST(Chart, LateFramesDoNotHideTheMedians) {
  Chart chart{"t", "x", "y", {}};
  for (const double time : {1.81, 1.82, 1.83, 1.84})
    chart.points.push_back({"p", time, time - 0.005, time == 1.82 ? 12.0 : time + 0.005, 0.1, {}});
  const std::string svg = svg_chart(chart);
  std::vector<double> places;
  for (std::size_t at = svg.find("cx=\""); at != std::string::npos; at = svg.find("cx=\"", at + 1))
    places.push_back(std::stod(svg.substr(at + 4)));
  ASSERT_EQ(places.size(), 4u);
  const double width = 752.0;  // of the axis [pixels]
  EXPECT_GT(places[3] - places[0], 0.1 * width);
  // Three bars of three strokes, and one of four, which ends in an arrow.
  EXPECT_EQ(count(svg, "class=\"spread\""), 13u);
}

TEST(Chart, DegenerateDataIsDrawn) {
  for (const double error : {0.0, 1e-9, 1.0}) {
    for (const double time : {0.0, 1e-6, 1e6}) {
      const Chart one{"t", "x", "y", {{"only", time, time, time, error, {}}}};
      const std::string svg = svg_chart(one);
      EXPECT_EQ(xml_fault(svg), "");
      EXPECT_EQ(svg.find("nan"), std::string::npos) << svg;
      EXPECT_EQ(svg.find("inf"), std::string::npos) << svg;
    }
  }
}

TEST(ChartAxis, IsLogarithmicFromADecadeOn) {
  const ChartAxis narrow({1.0, 9.0}, 0.0, 100.0), wide({1.0, 10.0}, 0.0, 100.0);
  EXPECT_FALSE(narrow.logarithmic());
  EXPECT_TRUE(wide.logarithmic());
  // Equal ratios are equal distances.
  EXPECT_NEAR(wide.place(4.0) - wide.place(2.0), wide.place(8.0) - wide.place(4.0), 1e-9);
  EXPECT_NEAR(narrow.place(4.0) - narrow.place(2.0), narrow.place(6.0) - narrow.place(4.0), 1e-9);
}

TEST(ChartAxis, ZeroLiesApartOnALogarithmicAxis) {
  const ChartAxis axis({0.0, 0.001, 0.1}, 400.0, 0.0);  // as the vertical one: upwards
  EXPECT_TRUE(axis.logarithmic());
  EXPECT_TRUE(axis.has_zero());
  EXPECT_EQ(axis.place(0.0), 400.0);
  EXPECT_LT(axis.place(0.001), 380.0);
  EXPECT_LT(axis.place(0.1), axis.place(0.01));
  EXPECT_GT(axis.place(0.1), 0.0);
}

TEST(ChartAxis, TicksAreRoundAndInside) {
  EXPECT_EQ(linear_ticks(0.0, 10.0, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(log_ticks(0.9, 25.0), (std::vector<double>{1, 2, 5, 10, 20}));
  EXPECT_EQ(log_ticks(1e-3, 1e3).size(), 7u);
  for (const double low : {0.0, 3.7, 1234.5}) {
    const std::vector<double> ticks = linear_ticks(low, low + 0.83, 6);
    EXPECT_GE(ticks.size(), 3u);
    EXPECT_LE(ticks.size(), 10u);
    for (const double tick : ticks) {
      EXPECT_GE(tick, low - 1e-9);
      EXPECT_LE(tick, low + 0.83 + 1e-9);
    }
  }
}

}  // namespace
}  // namespace skerry::measure
