#include "tools/skerry/compare/verdict.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
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

/// Pixels are compared in blocks: loops over one are simple enough for vectors.
constexpr std::size_t kBlock = 1024;
using Offs = std::array<std::uint8_t, kBlock>;

/// Number of pixels of the block that begins at a pixel.
std::size_t block_size(std::size_t first, std::size_t pixels) {
  return std::min(kBlock, pixels - first);
}

/// A channel's largest difference at each pixel of a block. @param a, b the block's first bytes.
void find_offs(const std::uint8_t* a, const std::uint8_t* b, std::size_t count, Offs& offs) {
  std::array<std::uint8_t, 4 * kBlock> by;
  for (std::size_t i = 0; i < 4 * count; ++i)
    by[i] = static_cast<std::uint8_t>(std::max(a[i], b[i]) - std::min(a[i], b[i]));
  for (std::size_t i = 0; i < count; ++i)
    offs[i] = std::max(std::max(by[4 * i], by[4 * i + 1]), by[4 * i + 2]);
}

/// Of linear light, summed over the channels of a pixel.
double squared_difference(const std::array<float, 256>& linear, const std::uint8_t* a,
                          const std::uint8_t* b) {
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

/// What of a picture FLIP is to compare: pixels that do not count, or are off by no more than the
/// code values of their part's tolerance, are the reference's.
std::vector<std::uint8_t> without_rounding(const platform::PngImage& reference,
                                           const platform::PngImage& actual,
                                           const game::Expectations& expected, const Parts& parts) {
  std::array<std::uint32_t, 256> most{};
  for (std::size_t i = 0; i < expected.regions.size(); ++i)
    most[i] = expected.regions[i].tolerance.code_values;
  most[expected.regions.size()] = expected.tolerance.code_values;
  most[kNotCompared] = 255;
  const std::size_t pixels = actual.pixels.size() / 4;
  std::vector<std::uint8_t> out(actual.pixels.size());
  Offs offs;
  std::array<std::uint32_t, kBlock> wanted, found;
  for (std::size_t first = 0; first < pixels; first += kBlock) {
    const std::size_t count = block_size(first, pixels);
    const std::uint8_t *a = &reference.pixels[4 * first], *b = &actual.pixels[4 * first];
    find_offs(a, b, count, offs);
    std::memcpy(wanted.data(), a, 4 * count);
    std::memcpy(found.data(), b, 4 * count);
    if (parts.empty()) {
      const std::uint32_t all = expected.tolerance.code_values;
      for (std::size_t i = 0; i < count; ++i) found[i] = offs[i] <= all ? wanted[i] : found[i];
    } else {
      for (std::size_t i = 0; i < count; ++i)
        found[i] = offs[i] <= most[parts[first + i]] ? wanted[i] : found[i];
    }
    std::memcpy(&out[4 * first], found.data(), 4 * count);
  }
  return out;
}

bool same_colors(const platform::PngImage& a, const platform::PngImage& b) {
  if (a.pixels == b.pixels) return true;
  const std::size_t pixels = a.pixels.size() / 4;
  Offs offs;
  for (std::size_t first = 0; first < pixels; first += kBlock) {
    const std::size_t count = block_size(first, pixels);
    find_offs(&a.pixels[4 * first], &b.pixels[4 * first], count, offs);
    if (std::any_of(offs.begin(), offs.begin() + static_cast<std::ptrdiff_t>(count),
                    [](std::uint8_t off) { return off != 0; }))
      return false;
  }
  return true;
}

/// Sums over pixels, without FLIP.
struct Sums {
  std::size_t counted = 0, over = 0, rounded = 0;
  int largest = 0;
  std::array<std::int64_t, 3> signed_{};  ///< of what rounded pixels are off by, a channel
  double squares = 0.0;                   ///< of linear light
};

/// Adds a block. @param offs of its pixels; 0 for those that do not count.
void add_block(Sums& sums, const std::uint8_t* a, const std::uint8_t* b, std::size_t count,
               const Offs& offs, const game::Tolerance& tolerance) {
  const std::uint32_t threshold = tolerance.channel_threshold, values = tolerance.code_values;
  std::uint32_t over = 0, rounded = 0, largest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t off = offs[i];
    largest = std::max(largest, off);
    over += off > threshold ? 1 : 0;
    rounded += off - 1 < values ? 1 : 0;  // 0 is none of them
  }
  sums.largest = std::max(sums.largest, static_cast<int>(largest));
  sums.over += over;
  sums.rounded += rounded;
  if (largest == 0) return;
  const std::array<float, 256>& linear = measure::linear_of_bytes();
  for (std::size_t i = 0; i < count; ++i)
    if (offs[i] != 0) sums.squares += squared_difference(linear, a + 4 * i, b + 4 * i);
  if (rounded == 0) return;
  std::array<std::int32_t, 3> signed_sums{};
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t here = std::uint32_t{offs[i]} <= values && offs[i] != 0 ? 1 : 0;
    for (std::size_t c = 0; c < 3; ++c)
      signed_sums[c] += here * (std::int32_t{b[4 * i + c]} - std::int32_t{a[4 * i + c]});
  }
  for (std::size_t c = 0; c < 3; ++c) sums.signed_[c] += signed_sums[c];
}

/// Takes every pixel of a picture.
struct EveryPixel {
  bool operator()(std::size_t) const { return true; }
};

template <class Counts>
Sums sums_of(const Compared& pair, const game::Tolerance& tolerance, const Counts& counts) {
  constexpr bool kEvery = std::is_same_v<Counts, EveryPixel>;
  const std::size_t pixels = pair.reference->pixels.size() / 4;
  Sums sums;
  Offs offs;
  for (std::size_t first = 0; first < pixels; first += kBlock) {
    const std::size_t count = block_size(first, pixels);
    const std::uint8_t *a = &pair.reference->pixels[4 * first],
                       *b = &pair.actual->pixels[4 * first];
    find_offs(a, b, count, offs);
    sums.counted += count;
    for (std::size_t i = 0; !kEvery && i < count; ++i) {
      if (counts(first + i)) continue;
      offs[i] = 0;
      --sums.counted;
    }
    add_block(sums, a, b, count, offs, tolerance);
  }
  return sums;
}

/// Over the pixels that `counts` accepts by their index. None: there are none.
template <class Counts>
std::optional<Difference> difference_of(const Compared& pair, const game::Tolerance& tolerance,
                                        const Counts& counts) {
  constexpr bool kEvery = std::is_same_v<Counts, EveryPixel>;
  const Sums sums = sums_of(pair, tolerance, counts);
  if (sums.counted == 0) return std::nullopt;
  const auto share = [&](auto part) {
    return static_cast<double>(part) / static_cast<double>(sums.counted);
  };
  Difference found;
  found.largest = sums.largest;
  found.pixels_over = share(sums.over);
  found.pixels_rounded = share(sums.rounded);
  found.bias =
      share(*std::ranges::max_element(sums.signed_, {}, [](auto sum) { return std::abs(sum); }));
  found.psnr_db = decibels(sums.squares, sums.counted);
  if (pair.flip->errors.empty()) return found;  // FLIP of equal pictures is 0 by definition
  measure::ErrorMap some{static_cast<std::uint32_t>(sums.counted), 1, {}};
  for (std::size_t i = 0; !kEvery && i < pair.flip->errors.size(); ++i)
    if (counts(i)) some.errors.push_back(pair.flip->errors[i]);
  const measure::ErrorMap& errors = kEvery ? *pair.flip : some;
  found.flip_mean = measure::mean_of(errors);
  found.flip_p99 = measure::quantile_of(errors, 0.99);
  found.flip_max = measure::max_of(errors);
  return found;
}

std::optional<Difference> difference_of(const Compared& pair, const game::Expectations& expected,
                                        const Parts& parts) {
  const game::Tolerance& tolerance = expected.tolerance;
  if (parts.empty()) return difference_of(pair, tolerance, EveryPixel{});
  return difference_of(pair, tolerance, [&](std::size_t i) { return parts[i] != kNotCompared; });
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
    const auto difference =
        difference_of(pair, tolerance, [&](std::size_t i) { return parts[i] == part; });
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
  measure::ErrorMap flip{reference.width, reference.height, {}};
  if (!same_colors(reference, *compared))
    // FLIP's filters would spread what does not count.
    flip = measure::flip_srgb(reference.width, reference.height, reference.pixels,
                              without_rounding(reference, *compared, expected, parts));
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
  check(fmt::format("share of pixels off by at most {}", tolerance.code_values).c_str(),
        found.pixels_rounded, tolerance.pixels_rounded);
  check("bias of those", std::abs(found.bias), tolerance.bias);
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
