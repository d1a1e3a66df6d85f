#include "tools/skerry/test/verdict.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "engine/core/check.h"
#include "tools/measure/image.h"

namespace skerry::tools {
namespace {

constexpr int kBright = 16;            // a channel from here on can be told from black
constexpr double kLeastBright = 0.01;  // share of pixels a picture that is not black has bright

measure::Picture linear_picture(const platform::PngImage& image) {
  return measure::picture_from({image.width, image.height, image.pixels});
}

/// Mean squared error of the channels becomes decibels below a peak of 1.
double decibels(double squares, std::size_t pixels) {
  if (squares == 0.0) return std::numeric_limits<double>::infinity();
  return -10.0 * std::log10(squares / (3.0 * static_cast<double>(pixels)));
}

/// A channel's largest difference at a pixel.
int off_by(const platform::PngImage& a, const platform::PngImage& b, std::size_t pixel) {
  int most = 0;
  for (std::size_t i = pixel * 4; i < pixel * 4 + 3; ++i)
    most = std::max(most, std::abs(int{a.pixels[i]} - int{b.pixels[i]}));
  return most;
}

double squared(const glm::vec3& a, const glm::vec3& b) {
  double sum = 0.0;
  for (int c = 0; c < 3; ++c) {
    const double off = static_cast<double>(a[c]) - static_cast<double>(b[c]);
    sum += off * off;
  }
  return sum;
}

}  // namespace

Comparison compare(const platform::PngImage& reference, const platform::PngImage& actual,
                   const game::Expectations& expected) {
  SKERRY_ASSERT(reference.width == actual.width && reference.height == actual.height);
  const measure::Picture left = linear_picture(reference);
  measure::Picture right = linear_picture(actual);
  Comparison out;
  Difference& found = out.difference;
  std::vector<std::size_t> compared;
  std::size_t over = 0;
  double squares = 0.0;
  for (std::size_t pixel = 0; pixel < left.pixels.size(); ++pixel) {
    const auto x = static_cast<std::uint32_t>(pixel % reference.width);
    const auto y = static_cast<std::uint32_t>(pixel / reference.width);
    if (game::is_masked(expected.masks, x, y)) {
      right.pixels[pixel] = left.pixels[pixel];  // or FLIP's filters would spread what it hides
      continue;
    }
    compared.push_back(pixel);
    const int off = off_by(reference, actual, pixel);
    found.largest = std::max(found.largest, off);
    over += off > static_cast<int>(expected.tolerance.channel_threshold) ? 1 : 0;
    squares += squared(left.pixels[pixel], right.pixels[pixel]);
  }
  SKERRY_ASSERT(!compared.empty());
  found.pixels_over = static_cast<double>(over) / static_cast<double>(compared.size());
  found.psnr_db = decibels(squares, compared.size());
  if (found.equal()) {  // FLIP of equal pictures is 0 by definition
    out.flip = {reference.width, reference.height, std::vector<float>(left.pixels.size())};
    return out;
  }
  out.flip = measure::flip_ldr(left, right);
  measure::ErrorMap counted{static_cast<std::uint32_t>(compared.size()), 1, {}};
  std::vector<float> shown(left.pixels.size());
  for (const std::size_t pixel : compared) {
    counted.errors.push_back(out.flip.errors[pixel]);
    shown[pixel] = out.flip.errors[pixel];
  }
  out.flip.errors = std::move(shown);
  found.flip_mean = measure::mean_of(counted);
  found.flip_p99 = measure::quantile_of(counted, 0.99);
  found.flip_max = measure::max_of(counted);
  return out;
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
