#include "tools/measure/flip.h"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

#include "engine/core/check.h"
#include "engine/core/jobs.h"
#include "tools/measure/color.h"
#include "tools/measure/flip_filters.h"
#include "tools/measure/quantile.h"

namespace skerry::measure {
namespace {

// The paper's constants, by its names.
constexpr double kQc = 0.7;   ///< exponent of the colour difference
constexpr double kPc = 0.4;   ///< share of the largest colour difference that ...
constexpr double kPt = 0.95;  ///< ... is mapped to this error
constexpr double kQf = 0.5;   ///< exponent of the feature difference

/// Rows filtered together: large against the filters' radius, small against a cache.
constexpr int kBandRows = 64;

/// Into [lowest, highest]; what is no number becomes the lowest.
double clamp_number(double value, double lowest, double highest) {
  return value > lowest ? std::min(value, highest) : lowest;
}

glm::dvec3 clamp_display(const glm::dvec3& linear) {
  return {clamp_number(linear.x, 0.0, 1.0), clamp_number(linear.y, 0.0, 1.0),
          clamp_number(linear.z, 0.0, 1.0)};
}

/// L*a*b* with chroma scaled by lightness: colours are harder to tell apart in the dark.
glm::dvec3 hunt_lab(const glm::dvec3& linear) {
  const glm::dvec3 lab = lab_from_linear(linear);
  return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}

double hyab(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 d = a - b;
  return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

/// Colour difference to error: linear up to a large difference, compressed above it.
double color_error(double difference) {
  static const double largest =
      std::pow(hyab(hunt_lab({0.0, 1.0, 0.0}), hunt_lab({0.0, 0.0, 1.0})), kQc);
  const double d = std::pow(difference, kQc), knee = kPc * largest;
  if (d < knee) return kPt / knee * d;
  return kPt + (d - knee) / (largest - knee) * (1.0 - kPt);
}

/// What FLIP sees of one picture, in some rows of it.
struct Seen {
  std::vector<glm::dvec3> colors;     ///< Hunt-adjusted L*a*b*, after the eye's blur
  std::vector<double> edges, points;  ///< magnitudes of the features
};

std::vector<double> magnitudes(const Plane& x, const Plane& y) {
  std::vector<double> out(x.values.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = std::sqrt(x.values[i] * x.values[i] + y.values[i] * y.values[i]);
  return out;
}

/// Rows [first, first + rows) of `picture`; rows beyond its ends repeat the last.
Seen see(const Picture& picture, const FlipFilters& filters, int first, int rows) {
  const int width = static_cast<int>(picture.width), margin = filters.radius();
  const int last_row = static_cast<int>(picture.height) - 1;
  Plane light(width, rows + 2 * margin), y = light, cx = light, cz = light;
  for (int row = 0; row < light.height; ++row) {
    const int from = std::clamp(first - margin + row, 0, last_row);
    const glm::vec3* pixels = picture.pixels.data() + static_cast<std::size_t>(from) * width;
    for (int x = 0; x < width; ++x) {
      const glm::dvec3 color = ycxcz_from_linear(clamp_display(glm::dvec3(pixels[x])));
      y.row(row)[x] = color.x;
      cx.row(row)[x] = color.y;
      cz.row(row)[x] = color.z;
      light.row(row)[x] = (color.x + 16.0) / 116.0;
    }
  }
  Seen seen;
  y = filter(y, filters.achromatic, margin);
  cx = filter(cx, filters.red_green, margin);
  cz = filter(cz, filters.blue_yellow, margin);
  seen.colors.resize(y.values.size());
  for (std::size_t i = 0; i < seen.colors.size(); ++i)
    seen.colors[i] =
        hunt_lab(clamp_display(linear_from_ycxcz({y.values[i], cx.values[i], cz.values[i]})));

  const Plane smooth = filter_rows(light, filters.smooth);
  seen.edges = magnitudes(filter_columns(filter_rows(light, filters.edge), filters.smooth, margin),
                          filter_columns(smooth, filters.edge, margin));
  seen.points =
      magnitudes(filter_columns(filter_rows(light, filters.point), filters.smooth, margin),
                 filter_columns(smooth, filters.point, margin));
  return seen;
}

void compare(const Seen& a, const Seen& b, float* errors) {
  for (std::size_t i = 0; i < a.colors.size(); ++i) {
    const double color = color_error(hyab(a.colors[i], b.colors[i]));
    const double feature =
        std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
    const double exponent = 1.0 - std::pow(feature / std::sqrt(2.0), kQf);
    errors[i] = static_cast<float>(clamp_number(std::pow(color, exponent), 0.0, 1.0));
  }
}

/// The ACES fit by K. Narkowicz that the HDR paper uses, with its factor 0.6 before the curve.
double tone_curve(double x) {
  x *= 0.6;
  return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

/// Where the tone curve reaches 0.85, the paper's "almost white".
double almost_white() {
  constexpr double kLevel = 0.85;
  const double a = 2.51 - kLevel * 2.43, b = 0.03 - kLevel * 0.59, c = -kLevel * 0.14;
  return (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a) / 0.6;
}

Picture exposed(const Picture& picture, double factor) {
  // Far above this the curve is flat, and below it nothing overflows.
  constexpr double kBrightest = 1e6;
  Picture out{picture.width, picture.height, {}};
  out.pixels.reserve(picture.pixels.size());
  const auto curve = [&](float radiance) {
    const double x = clamp_number(radiance * factor, 0.0, kBrightest);
    return static_cast<float>(std::min(tone_curve(x), 1.0));
  };
  for (const glm::vec3& pixel : picture.pixels)
    out.pixels.emplace_back(curve(pixel.x), curve(pixel.y), curve(pixel.z));
  return out;
}

/// Luminances above zero of the finite pixels.
std::vector<double> lit(const Picture& picture) {
  std::vector<double> out;
  for (const glm::vec3& pixel : picture.pixels) {
    const double y = luminance(glm::dvec3(pixel));
    if (y > 0.0 && std::isfinite(y)) out.push_back(y);
  }
  return out;
}

void check_sizes(const Picture& a, const Picture& b) {
  SKERRY_ASSERT(a.width == b.width && a.height == b.height && a.width > 0 && a.height > 0);
  SKERRY_ASSERT(a.pixels.size() == std::size_t{a.width} * a.height);
  SKERRY_ASSERT(b.pixels.size() == a.pixels.size());
}

}  // namespace

ErrorMap flip_ldr(const Picture& reference, const Picture& test, double pixels_per_degree) {
  check_sizes(reference, test);
  const FlipFilters filters(pixels_per_degree);
  ErrorMap map{reference.width, reference.height, {}};
  map.errors.resize(reference.pixels.size());
  const int height = static_cast<int>(map.height);
  Jobs jobs;
  jobs.parallel_for((height + kBandRows - 1) / kBandRows, [&](int band) {
    const int first = band * kBandRows, rows = std::min(kBandRows, height - first);
    compare(see(reference, filters, first, rows), see(test, filters, first, rows),
            map.errors.data() + static_cast<std::size_t>(first) * map.width);
  });
  return map;
}

ExposureRange exposure_range(const Picture& reference, const Picture& test) {
  std::vector<double> luminances = lit(reference);
  if (luminances.empty()) luminances = lit(test);
  if (luminances.empty()) return {0.0, 0.0, 1};
  const double median = quantile(luminances, 0.5);
  const double brightest = *std::max_element(luminances.begin(), luminances.end());
  const double first = std::log2(almost_white() / brightest);
  const double last = std::log2(almost_white() / median);
  if (first == last) return {first, last, 1};
  return {first, last, std::max(2, static_cast<int>(std::ceil(last - first)))};
}

ErrorMap flip_hdr(const Picture& reference, const Picture& test, const ExposureRange& range,
                  double pixels_per_degree) {
  check_sizes(reference, test);
  SKERRY_ASSERT(range.count >= 1);
  ErrorMap worst{reference.width, reference.height, {}};
  worst.errors.resize(reference.pixels.size());
  for (int i = 0; i < range.count; ++i) {
    const double share = range.count == 1 ? 0.0 : i / (range.count - 1.0);
    const double factor = std::exp2(range.first + share * (range.last - range.first));
    const ErrorMap map =
        flip_ldr(exposed(reference, factor), exposed(test, factor), pixels_per_degree);
    for (std::size_t p = 0; p < map.errors.size(); ++p)
      worst.errors[p] = std::max(worst.errors[p], map.errors[p]);
  }
  return worst;
}

double mean_of(const ErrorMap& map) {
  SKERRY_ASSERT(!map.errors.empty());
  double sum = 0.0;
  for (const float error : map.errors) sum += error;
  return sum / static_cast<double>(map.errors.size());
}

double quantile_of(const ErrorMap& map, double share) {
  std::vector<float> errors = map.errors;
  return quantile(errors, share);
}

double max_of(const ErrorMap& map) {
  SKERRY_ASSERT(!map.errors.empty());
  return *std::max_element(map.errors.begin(), map.errors.end());
}

}  // namespace skerry::measure
