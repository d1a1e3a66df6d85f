#include "tools/skerry/compare/verdict.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <type_traits>

#include "engine/core/check.h"
#include "tools/measure/color.h"

namespace skerry::tools {
namespace {

constexpr int kBright = 16;            // a channel from here on can be told from black
constexpr double kLeastBright = 0.01;  // share of pixels a picture that is not black has bright

/// Mean squared error of the channels becomes decibels below a peak of 1.
double decibels(double squares, std::size_t pixels) {
  if (squares == 0.0) return std::numeric_limits<double>::infinity();
  return -10.0 * std::log10(squares / (3.0 * static_cast<double>(pixels)));
}

/// A channel's largest difference at a pixel.
int off_by(const std::uint8_t* a, const std::uint8_t* b) {
  int most = 0;
  for (int i = 0; i < 3; ++i) most = std::max(most, std::abs(int{a[i]} - int{b[i]}));
  return most;
}

/// Of linear light, summed over the channels of a pixel.
double squared_difference(const std::uint8_t* a, const std::uint8_t* b) {
  const std::array<float, 256>& linear = measure::linear_of_bytes();
  double sum = 0.0;
  for (int c = 0; c < 3; ++c) {
    const double off = static_cast<double>(linear[a[c]]) - static_cast<double>(linear[b[c]]);
    sum += off * off;
  }
  return sum;
}

/// Which part of a picture each pixel belongs to: a region's index, as many as there are for what
/// lies in none, or kNotCompared. Empty: all pixels are one part.
using Parts = std::vector<std::uint8_t>;
constexpr std::uint8_t kNotCompared = 255;
static_assert(game::kMaxRegions < kNotCompared);

void paint(Parts& parts, std::uint32_t width, const game::Mask& rectangle, std::uint8_t part) {
  for (std::uint32_t y = rectangle.y; y < rectangle.y + rectangle.height; ++y)
    std::fill_n(parts.begin() + static_cast<std::ptrdiff_t>(y) * width + rectangle.x,
                rectangle.width, part);
}

/// Takes away the pixels of the reference that have no partner.
void cut_edges(Parts& parts, std::uint32_t width, std::uint32_t height, const Shift& shift) {
  const auto right = static_cast<std::uint32_t>(std::max(shift.dx, 0));
  const auto left = static_cast<std::uint32_t>(std::max(-shift.dx, 0));
  const auto bottom = static_cast<std::uint32_t>(std::max(shift.dy, 0));
  const auto top = static_cast<std::uint32_t>(std::max(-shift.dy, 0));
  paint(parts, width, {0, 0, width, top}, kNotCompared);
  paint(parts, width, {0, height - bottom, width, bottom}, kNotCompared);
  paint(parts, width, {0, 0, left, height}, kNotCompared);
  paint(parts, width, {width - right, 0, right, height}, kNotCompared);
}

Parts parts_of(const game::Expectations& expected, std::uint32_t width, std::uint32_t height,
               const Shift& shift) {
  if (expected.regions.empty() && expected.masks.empty() && shift == Shift{}) return {};
  const auto count = static_cast<std::uint8_t>(expected.regions.size());
  Parts parts(std::size_t{width} * height, count);
  for (std::uint8_t i = count; i-- > 0;)  // the first of those that overlap is painted last
    paint(parts, width, expected.regions[i].rectangle, i);
  for (const game::Mask& mask : expected.masks) paint(parts, width, mask, kNotCompared);
  cut_edges(parts, width, height, shift);
  return parts;
}

/// Two pictures in all forms that are compared.
struct Compared {
  const platform::PngImage *reference, *actual;
  const measure::ErrorMap* flip;  ///< empty: the pictures are equal
};

bool same_colors(const platform::PngImage& a, const platform::PngImage& b) {
  if (a.pixels == b.pixels) return true;
  for (std::size_t i = 0; i < a.pixels.size(); i += 4)
    if (off_by(&a.pixels[i], &b.pixels[i]) != 0) return false;
  return true;
}

/// Takes every pixel of a picture.
struct EveryPixel {
  bool operator()(std::size_t) const { return true; }
};

/// Over the pixels that `counts` accepts by their index. None: there are none.
template <class Counts>
std::optional<Difference> difference_of(const Compared& pair, std::uint32_t threshold,
                                        const Counts& counts) {
  constexpr bool kEvery = std::is_same_v<Counts, EveryPixel>;
  const std::size_t pixels = pair.reference->pixels.size() / 4;
  Difference found;
  std::size_t counted = 0, over = 0;
  double squares = 0.0;
  measure::ErrorMap some{0, 1, {}};
  for (std::size_t i = 0; i < pixels; ++i) {
    if (!counts(i)) continue;
    ++counted;
    if (pair.flip->errors.empty()) continue;
    if (!kEvery) some.errors.push_back(pair.flip->errors[i]);
    const std::uint8_t *a = &pair.reference->pixels[4 * i], *b = &pair.actual->pixels[4 * i];
    const int off = off_by(a, b);
    if (off == 0) continue;
    found.largest = std::max(found.largest, off);
    over += off > static_cast<int>(threshold) ? 1 : 0;
    squares += squared_difference(a, b);
  }
  if (counted == 0) return std::nullopt;
  found.pixels_over = static_cast<double>(over) / static_cast<double>(counted);
  found.psnr_db = decibels(squares, counted);
  if (pair.flip->errors.empty()) return found;  // FLIP of equal pictures is 0 by definition
  some.width = static_cast<std::uint32_t>(counted);
  const measure::ErrorMap& errors = kEvery ? *pair.flip : some;
  found.flip_mean = measure::mean_of(errors);
  found.flip_p99 = measure::quantile_of(errors, 0.99);
  found.flip_max = measure::max_of(errors);
  return found;
}

std::optional<Difference> difference_of(const Compared& pair, const game::Expectations& expected,
                                        const Parts& parts) {
  const std::uint32_t threshold = expected.tolerance.channel_threshold;
  if (parts.empty()) return difference_of(pair, threshold, EveryPixel{});
  return difference_of(pair, threshold, [&](std::size_t i) { return parts[i] != kNotCompared; });
}

/// A part that masks or a shift leave nothing of is left out.
std::vector<PartDifference> differences_of_parts(const Compared& pair,
                                                 const game::Expectations& expected,
                                                 const Parts& parts) {
  std::vector<PartDifference> found;
  if (expected.regions.empty()) return found;
  for (std::size_t part = 0; part <= expected.regions.size(); ++part) {
    const bool is_region = part < expected.regions.size();
    const game::Tolerance& tolerance =
        is_region ? expected.regions[part].tolerance : expected.tolerance;
    const auto difference = difference_of(pair, tolerance.channel_threshold,
                                          [&](std::size_t i) { return parts[i] == part; });
    if (!difference) continue;
    found.push_back(
        {is_region ? expected.regions[part].name : std::string(game::kElsewhere), *difference});
  }
  return found;
}

}  // namespace

Comparison compare(const platform::PngImage& reference, const platform::PngImage& actual,
                   const game::Expectations& expected) {
  SKERRY_ASSERT(reference.width == actual.width && reference.height == actual.height);
  Comparison out;
  platform::PngImage changed;
  const platform::PngImage* compared = &actual;
  if (expected.shift > 0) {
    out.shift = best_shift(reference, actual, static_cast<int>(expected.shift));
    if (*out.shift != Shift{}) {
      changed = moved(actual, *out.shift);
      compared = &changed;
    }
  }
  const Parts parts =
      parts_of(expected, reference.width, reference.height, out.shift.value_or(Shift{}));
  if (!parts.empty() && compared == &actual) {
    changed = actual;
    compared = &changed;
  }
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (parts[i] == kNotCompared)  // or FLIP's filters would spread what it hides
      std::copy_n(&reference.pixels[4 * i], 4, &changed.pixels[4 * i]);
  measure::ErrorMap flip{reference.width, reference.height, {}};
  if (!same_colors(reference, *compared))
    flip =
        measure::flip_srgb(reference.width, reference.height, reference.pixels, compared->pixels);
  const Compared pair{&reference, compared, &flip};
  const std::optional<Difference> whole = difference_of(pair, expected, parts);
  SKERRY_ASSERT(whole.has_value());
  out.difference = *whole;
  out.parts = differences_of_parts(pair, expected, parts);
  flip.errors.resize(reference.pixels.size() / 4);
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (parts[i] == kNotCompared) flip.errors[i] = 0.0f;
  out.flip = std::move(flip);
  return out;
}

std::string beyond(const Difference& found, std::span<const PartDifference> parts,
                   const game::Expectations& expected) {
  if (parts.empty()) return beyond(found, expected.tolerance);
  std::vector<std::string> over;
  for (const PartDifference& part : parts) {
    const auto region = std::ranges::find(expected.regions, part.name, &game::Region::name);
    const game::Tolerance& tolerance =
        region == expected.regions.end() ? expected.tolerance : region->tolerance;
    const std::string found_here = beyond(part.difference, tolerance);
    if (!found_here.empty()) over.push_back(fmt::format("{}: {}", part.name, found_here));
  }
  return fmt::format("{}", fmt::join(over, "; "));
}

std::string beyond(const Difference& found, const game::Tolerance& tolerance) {
  std::vector<std::string> over;
  const auto check = [&](const char* what, double value, double most) {
    if (!(value <= most)) over.push_back(fmt::format("{} {:.5f} over {}", what, value, most));
  };
  check("FLIP mean", found.flip_mean, tolerance.flip_mean);
  check("FLIP p99", found.flip_p99, tolerance.flip_p99);
  check("FLIP max", found.flip_max, tolerance.flip_max);
  check(fmt::format("share of pixels off by more than {}", tolerance.channel_threshold).c_str(),
        found.pixels_over, tolerance.pixels_over);
  return fmt::format("{}", fmt::join(over, ", "));
}

bool is_black(const platform::PngImage& picture) {
  std::size_t bright = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); i += 4) {
    const auto channels = picture.pixels.begin() + static_cast<std::ptrdiff_t>(i);
    bright += *std::max_element(channels, channels + 3) >= kBright ? 1 : 0;
  }
  return static_cast<double>(bright) <
         kLeastBright * static_cast<double>(picture.pixels.size()) / 4;
}

}  // namespace skerry::tools
