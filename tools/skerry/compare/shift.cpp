#include "tools/skerry/compare/shift.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <optional>

#include "engine/core/check.h"

namespace skerry::tools {
namespace {

/// The part of a reference's rows or columns that has a partner.
struct Range {
  std::size_t first, count;
};

Range with_partner(std::uint32_t size, int shift) {
  return {static_cast<std::size_t>(std::max(-shift, 0)), size - std::abs(shift)};
}

/// Index of a pixel's first byte.
std::size_t byte_at(const platform::PngImage& image, std::size_t x, std::size_t y) {
  return 4 * (y * image.width + x);
}

std::uint64_t sum_of_differences(const std::uint8_t* a, const std::uint8_t* b, std::size_t count) {
  std::uint64_t sum = 0;
  // A block's sum fits 32 bits, of which vectors hold more.
  constexpr std::size_t kBlock = std::size_t{1} << 16;
  for (std::size_t from = 0; from < count; from += kBlock) {
    std::uint32_t block = 0;
    for (std::size_t i = from; i < std::min(from + kBlock, count); ++i)
      block += static_cast<std::uint32_t>(std::abs(int{a[i]} - int{b[i]}));
    sum += block;
  }
  return sum;
}

/// None: it is over `least` and was given up.
std::optional<double> mean_difference(const platform::PngImage& reference,
                                      const platform::PngImage& actual, const Shift& shift,
                                      double least) {
  const Range columns = with_partner(reference.width, shift.dx);
  const Range rows = with_partner(reference.height, shift.dy);
  const double bytes = 4.0 * static_cast<double>(columns.count) * static_cast<double>(rows.count);
  std::uint64_t sum = 0;
  for (std::size_t y = rows.first; y < rows.first + rows.count; ++y) {
    const std::size_t x = columns.first;
    sum += sum_of_differences(&reference.pixels[byte_at(reference, x, y)],
                              &actual.pixels[byte_at(actual, x + static_cast<std::size_t>(shift.dx),
                                                     y + static_cast<std::size_t>(shift.dy))],
                              4 * columns.count);
    if (static_cast<double>(sum) / bytes > least) return std::nullopt;
  }
  return static_cast<double>(sum) / bytes;
}

/// Opaque: transparency is not compared.
platform::PngImage opaque(platform::PngImage image) {
  for (std::size_t i = 3; i < image.pixels.size(); i += 4) image.pixels[i] = 255;
  return image;
}

std::vector<Shift> nearest_first(int most) {
  std::vector<Shift> shifts;
  for (int dy = -most; dy <= most; ++dy)
    for (int dx = -most; dx <= most; ++dx) shifts.push_back({dx, dy});
  const auto distance = [](const Shift& s) { return s.dx * s.dx + s.dy * s.dy; };
  std::ranges::stable_sort(shifts, {}, distance);
  return shifts;
}

}  // namespace

Shift best_shift(const platform::PngImage& reference, const platform::PngImage& actual, int most) {
  SKERRY_ASSERT(reference.width == actual.width && reference.height == actual.height);
  SKERRY_ASSERT(most >= 0 && reference.width > static_cast<std::uint32_t>(most) &&
                reference.height > static_cast<std::uint32_t>(most));
  const platform::PngImage left = opaque(reference), right = opaque(actual);
  Shift best;
  double least = std::numeric_limits<double>::infinity();
  for (const Shift& shift : nearest_first(most)) {
    const std::optional<double> mean = mean_difference(left, right, shift, least);
    if (!mean || *mean >= least) continue;
    best = shift;
    least = *mean;
    if (least == 0.0) break;
  }
  return best;
}

platform::PngImage moved(const platform::PngImage& picture, const Shift& shift) {
  platform::PngImage out{picture.width, picture.height, {}, {}};
  out.pixels.resize(picture.pixels.size());
  for (std::size_t i = 3; i < out.pixels.size(); i += 4) out.pixels[i] = 255;
  const Range columns = with_partner(picture.width, shift.dx);
  const Range rows = with_partner(picture.height, shift.dy);
  for (std::size_t y = rows.first; y < rows.first + rows.count; ++y) {
    const std::size_t from = byte_at(picture, columns.first + static_cast<std::size_t>(shift.dx),
                                     y + static_cast<std::size_t>(shift.dy));
    std::copy_n(picture.pixels.begin() + static_cast<std::ptrdiff_t>(from), 4 * columns.count,
                out.pixels.begin() + static_cast<std::ptrdiff_t>(byte_at(out, columns.first, y)));
  }
  return out;
}

}  // namespace skerry::tools
