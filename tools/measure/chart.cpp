#include "tools/measure/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/check.h"
#include "tools/measure/chart_axis.h"
#include "tools/measure/html.h"
#include "tools/measure/pareto.h"

namespace skerry::measure {
namespace {

// The drawing, in pixels.
constexpr double kWidth = 860.0, kHeight = 520.0;
constexpr double kLeft = 84.0, kRight = 836.0, kTop = 56.0, kBottom = 452.0;
constexpr double kCharWidth = 6.7, kLineHeight = 15.0;  ///< of labels, a generous estimate

constexpr std::string_view kStyle = R"(
  text { font: 12px system-ui, 'DejaVu Sans', sans-serif; fill: #30363d; }
  .paper { fill: #ffffff; }
  .title { font-size: 16px; font-weight: 600; }
  .tick { fill: #5d6673; }
  .grid { stroke: #e3e6ea; stroke-width: 1; }
  .axis { stroke: #8a929c; stroke-width: 1; }
  .front { fill: none; stroke: #0b6bcb; stroke-width: 2; stroke-linejoin: round; }
  .spread { stroke: #8a929c; stroke-width: 1.5; }
  .leader { stroke: #b4bbc4; stroke-width: 1; }
  .on { fill: #0b6bcb; }
  .off { fill: #ffffff; stroke: #6b7480; stroke-width: 1.5; }
  .ring { fill: none; stroke: #0f7b45; stroke-width: 2.5; }
  .doubt { fill: none; stroke: #b06a00; stroke-width: 2.5; }
  .wrong { fill: none; stroke: #c5221f; stroke-width: 2.5; }
  .default { font-weight: 600; fill: #0f7b45; }
  .doubtful { font-weight: 600; fill: #b06a00; }
  .defect { font-weight: 600; fill: #c5221f; }
  @media (prefers-color-scheme: dark) {
    text { fill: #d7dce2; }
    .paper { fill: #15181c; }
    .tick { fill: #9aa4b1; }
    .grid { stroke: #2a3037; }
    .axis, .spread { stroke: #7b8590; }
    .front { stroke: #6cb1ff; }
    .leader { stroke: #4c555f; }
    .on { fill: #6cb1ff; }
    .off { fill: #15181c; stroke: #9aa4b1; }
    .ring { stroke: #5bd08f; }
    .doubt { stroke: #f2b84b; }
    .wrong { stroke: #ff8a80; }
    .default { fill: #5bd08f; }
    .doubtful { fill: #f2b84b; }
    .defect { fill: #ff8a80; }
  }
)";

/// How a mark is drawn and said.
struct MarkLooks {
  std::string_view ring, note, words;
};
constexpr MarkLooks kMarks[] = {{"ring", "default", ""},
                                {"doubt", "doubtful", " (off the front?)"},
                                {"wrong", "defect", " (off the front)"}};

const MarkLooks& looks_of(const ChartPoint& point) {
  return kMarks[static_cast<std::size_t>(point.mark)];
}

struct Box {
  double x0, y0, x1, y1;
};

double overlap(const Box& a, const Box& b) {
  const double w = std::min(a.x1, b.x1) - std::max(a.x0, b.x0);
  const double h = std::min(a.y1, b.y1) - std::max(a.y0, b.y0);
  return w > 0.0 && h > 0.0 ? w * h : 0.0;
}

Box around(double x, double y, double radius) {
  return {x - radius, y - radius, x + radius, y + radius};
}

std::string line(std::string_view css, double x0, double y0, double x1, double y1) {
  return fmt::format(
      "<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", css, x0, y0,
      x1, y1);
}

std::string circle(std::string_view css, double x, double y, double radius) {
  return fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>\n", css, x, y,
                     radius);
}

/// @param anchor start, middle or end
std::string text(std::string_view css, double x, double y, std::string_view anchor,
                 std::string_view content) {
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n",
                     css, x, y, anchor, escape(content));
}

std::size_t characters(std::string_view utf8) {
  return static_cast<std::size_t>(
      std::count_if(utf8.begin(), utf8.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

/// Draws one chart; the members are its parts, in the order they are drawn.
class Drawing {
 public:
  explicit Drawing(const Chart& chart)
      : chart_(chart), x_(times(chart), kLeft, kRight), y_(errors(chart), kBottom, kTop) {
    std::vector<Cost> costs;
    for (const ChartPoint& point : chart.points) costs.push_back({point.time, point.error});
    front_ = pareto_front(costs);
  }

  std::string draw() {
    draw_axes();
    draw_front();
    draw_points();
    for (std::size_t i = 0; i < chart_.points.size(); ++i) draw_label(i);
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
        "height=\"{1}\" role=\"img\">\n<title>{2}</title>\n<style>{3}</style>\n"
        "<rect class=\"paper\" width=\"{0}\" height=\"{1}\"/>\n{4}</svg>\n",
        kWidth, kHeight, escape(chart_.title), kStyle, out_);
  }

 private:
  /// The medians, and of the spreads what is no further from them than they are from each other
  /// (or a twentieth of the longest): a few late frames must not hide what the chart compares.
  static std::vector<double> times(const Chart& chart) {
    const auto [least, most] = std::ranges::minmax(chart.points, {}, &ChartPoint::time);
    const double room = std::max(most.time - least.time, 0.05 * most.time);
    const double low = std::max(least.time - room, 0.0), high = most.time + room;
    std::vector<double> values;
    for (const ChartPoint& point : chart.points)
      values.insert(values.end(), {std::clamp(point.time_low, low, high), point.time,
                                   std::clamp(point.time_high, low, high)});
    return values;
  }
  static std::vector<double> errors(const Chart& chart) {
    std::vector<double> values;
    for (const ChartPoint& point : chart.points) values.push_back(point.error);
    return values;
  }

  double x_of(std::size_t i) const { return x_.place(chart_.points[i].time); }
  double y_of(std::size_t i) const { return y_.place(chart_.points[i].error); }

  void draw_axes() {
    out_ += text("title", kLeft, 28, "start", chart_.title);
    for (const double tick : x_.ticks()) {
      const double x = x_.place(tick);
      out_ += line("grid", x, kTop, x, kBottom);
      out_ += text("tick", x, kBottom + 20, "middle", fmt::format("{:.6g}", tick));
    }
    for (const double tick : y_.ticks()) {
      const double y = y_.place(tick);
      out_ += line("grid", kLeft, y, kRight, y);
      out_ += text("tick", kLeft - 8, y + 4, "end", fmt::format("{:.6g}", tick));
    }
    if (y_.has_zero()) out_ += text("tick", kLeft - 8, kBottom + 4, "end", "0");
    out_ += line("axis", kLeft, kBottom, kRight, kBottom);
    out_ += line("axis", kLeft, kTop, kLeft, kBottom);
    out_ += text("tick", (kLeft + kRight) / 2, kHeight - 16, "middle",
                 chart_.time_label + (x_.logarithmic() ? " (logarithmic)" : ""));
    const double middle = (kTop + kBottom) / 2;
    out_ += fmt::format(
        "<text class=\"tick\" transform=\"translate(18 {:.1f}) rotate(-90)\" "
        "text-anchor=\"middle\">{}</text>\n",
        middle, escape(chart_.error_label + (y_.logarithmic() ? " (logarithmic)" : "")));
  }

  /// What is not worse than any point lies on or right of and above this staircase.
  void draw_front() {
    std::string path = fmt::format("M{:.1f} {:.1f}", x_of(front_.front()), kTop);
    for (std::size_t n = 0; n < front_.size(); ++n) {
      if (n > 0) path += fmt::format(" H{:.1f}", x_of(front_[n]));
      path += fmt::format(" V{:.1f}", y_of(front_[n]));
    }
    out_ += fmt::format("<path class=\"front\" d=\"{} H{:.1f}\"/>\n", path, kRight);
  }

  void draw_points() {
    for (std::size_t i = 0; i < chart_.points.size(); ++i) {
      const ChartPoint& point = chart_.points[i];
      const double x = x_of(i), y = y_of(i);
      const double low = std::max(x_.place(point.time_low), kLeft);
      const double high = std::min(x_.place(point.time_high), kRight);
      out_ += line("spread", low, y, high, y) + line("spread", low, y - 4, low, y + 4);
      if (x_.place(point.time_high) > kRight)  // it goes on
        out_ += line("spread", high - 5, y - 4, high, y) + line("spread", high - 5, y + 4, high, y);
      else
        out_ += line("spread", high, y - 4, high, y + 4);
      const bool on = std::find(front_.begin(), front_.end(), i) != front_.end();
      out_ += circle(on ? "on" : "off", x, y, 5);
      if (!point.defaults.empty()) out_ += circle(looks_of(point).ring, x, y, 10);
      taken_.push_back(around(x, y, point.defaults.empty() ? 7.0 : 12.0));
      taken_.push_back({low, y - 4, high, y + 4});
    }
  }

  /// Where a label of this size overlaps nothing: tries rings of places about the point.
  Box place_label(double x, double y, double width, double height) const {
    Box best{};
    double least = 1e30;
    for (int ring = 0; ring < 6; ++ring) {
      for (int step = 0; step < 16; ++step) {
        const double angle = (step - 2) * std::acos(-1.0) / 8.0, radius = 14.0 + 20.0 * ring;
        const double cx = x + std::cos(angle) * (radius + width / 2);
        const double cy = y + std::sin(angle) * (radius + height / 2);
        const Box box{cx - width / 2, cy - height / 2, cx + width / 2, cy + height / 2};
        double cost = 6.0 * ring + 0.5 * step;
        for (const Box& other : taken_) cost += 4.0 * overlap(box, other);
        cost += overlap_with_front(box);
        cost += width * height - overlap(box, {kLeft + 4, kTop, kRight, kBottom - 4});
        if (cost < least) {
          least = cost;
          best = box;
        }
      }
    }
    return best;
  }

  double overlap_with_front(const Box& box) const {
    double sum = 0.0;
    for (std::size_t n = 0; n < front_.size(); ++n) {
      const double x = x_of(front_[n]), y = y_of(front_[n]);
      const double right = n + 1 < front_.size() ? x_of(front_[n + 1]) : kRight;
      const double top = n == 0 ? kTop : y_of(front_[n - 1]);
      sum += overlap(box, {x, y - 2, right, y + 2}) + overlap(box, {x - 2, top, x + 2, y});
    }
    return 3.0 * sum;
  }

  void draw_label(std::size_t i) {
    const ChartPoint& point = chart_.points[i];
    std::string note;
    for (const std::string& level : point.defaults) note += (note.empty() ? "" : ", ") + level;
    if (!note.empty()) note = fmt::format("default: {}{}", note, looks_of(point).words);
    const double width =
        kCharWidth * static_cast<double>(std::max(characters(point.label), characters(note)));
    const double height = note.empty() ? kLineHeight : 2 * kLineHeight;
    const double x = x_of(i), y = y_of(i);
    const Box box = place_label(x, y, width, height);
    taken_.push_back({box.x0 - 5.0, box.y0, box.x1 + 5.0, box.y1});
    const double near_x = std::clamp(x, box.x0, box.x1), near_y = std::clamp(y, box.y0, box.y1);
    if (std::hypot(near_x - x, near_y - y) > 24.0) out_ += line("leader", x, y, near_x, near_y);
    const bool left_of_point = (box.x0 + box.x1) / 2 < x;
    const double at = left_of_point ? box.x1 : box.x0;
    const char* anchor = left_of_point ? "end" : "start";
    out_ += text("label", at, box.y0 + 11.5, anchor, point.label);
    if (!note.empty())
      out_ += text(looks_of(point).note, at, box.y0 + 11.5 + kLineHeight, anchor, note);
  }

  const Chart& chart_;
  ChartAxis x_, y_;
  std::vector<std::size_t> front_;
  std::vector<Box> taken_;
  std::string out_;
};

}  // namespace

std::string svg_chart(const Chart& chart) {
  SKERRY_ASSERT(!chart.points.empty());
  return Drawing(chart).draw();
}

}  // namespace skerry::measure
