#include "tools/measure/flip.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/vec3.hpp>

#include "engine/core/check.h"
#include "tools/measure/color.h"
#include "tools/measure/flip_kernel.h"
#include "tools/measure/quantile.h"

namespace skerry::measure {
namespace {

/// Into [lowest, highest]; what is no number becomes the lowest.
double clamp_number(double value, double lowest, double highest) {
  return value > lowest ? std::min(value, highest) : lowest;
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
  const flip_detail::Kernel& kernel = *flip_detail::kernels().front();
  return {
      reference.width, reference.height,
      flip_detail::errors_with(kernel, flip_detail::pair_of(reference, test), pixels_per_degree)};
}

ErrorMap flip_srgb(std::uint32_t width, std::uint32_t height,
                   std::span<const std::uint8_t> reference, std::span<const std::uint8_t> test,
                   double pixels_per_degree) {
  const std::size_t bytes = std::size_t{width} * height * 4;
  SKERRY_ASSERT(bytes > 0 && reference.size() == bytes && test.size() == bytes);
  const float* decoded = linear_of_bytes().data();
  const flip_detail::Pair pair{
      width, height, {{nullptr, reference.data(), decoded}, {nullptr, test.data(), decoded}}};
  const flip_detail::Kernel& kernel = *flip_detail::kernels().front();
  return {width, height, flip_detail::errors_with(kernel, pair, pixels_per_degree)};
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
  SKERRY_ASSERT(!map.errors.empty() && share >= 0.0 && share <= 1.0);
  // Numbers of one sign are in the order of their bits: the upper half is counted, then what shares
  // that of the one wanted is sorted. No copy of the map is made.
  const auto upper = [](float error) { return std::bit_cast<std::uint32_t>(error) >> 16; };
  std::vector<std::size_t> counts(std::size_t{1} << 16);
  for (const float error : map.errors) ++counts[upper(error)];
  std::size_t left = rank_of(map.errors.size(), share);
  std::uint32_t half = 0;
  for (; left >= counts[half]; ++half) left -= counts[half];
  std::vector<float> alike;
  for (const float error : map.errors)
    if (upper(error) == half) alike.push_back(error);
  std::nth_element(alike.begin(), alike.begin() + static_cast<std::ptrdiff_t>(left), alike.end());
  return alike[left];
}

double max_of(const ErrorMap& map) {
  SKERRY_ASSERT(!map.errors.empty());
  return *std::max_element(map.errors.begin(), map.errors.end());
}

}  // namespace skerry::measure
