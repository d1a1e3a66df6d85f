// Compares a picture with its reference:
//   skerry_compare_images REFERENCE.png ACTUAL.png [DIFFERENCE.png]
// Prints one line of JSON. Exit status: 0 alike, 1 different, 2 a picture cannot be read.
// DIFFERENCE.png gets what is different, eight times as strong, if anything is.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "engine/platform/image_file.h"

namespace skerry {
namespace {

// Drivers and compilers round differently: each channel may be off by this much, and a few pixels,
// on edges, by more.
constexpr int kTolerance = 8;
constexpr double kOutlierShare = 0.005;
constexpr int kAmplification = 8;
constexpr int kBright = 16;  // a channel from here on can be seen against black

struct Comparison {
  std::size_t pixels = 0, different = 0, outliers = 0, bright = 0;
  int largest = 0;
  std::vector<std::uint8_t> difference;  // RGB

  bool exact() const { return different == 0; }
  bool alike() const {
    return static_cast<double>(outliers) <= kOutlierShare * static_cast<double>(pixels);
  }
};

Comparison compared(const platform::PngImage& expected, const platform::PngImage& actual) {
  Comparison out;
  out.pixels = std::size_t{actual.width} * actual.height;
  for (std::size_t pixel = 0; pixel < out.pixels; ++pixel) {
    int most = 0, brightest = 0;
    for (std::size_t i = pixel * 4; i < pixel * 4 + 3; ++i) {
      const int off = std::abs(int{expected.pixels[i]} - int{actual.pixels[i]});
      out.difference.push_back(static_cast<std::uint8_t>(std::min(255, off * kAmplification)));
      most = std::max(most, off);
      brightest = std::max(brightest, int{actual.pixels[i]});
    }
    out.different += most != 0 ? 1 : 0;
    out.outliers += most > kTolerance ? 1 : 0;
    out.bright += brightest >= kBright ? 1 : 0;
    out.largest = std::max(out.largest, most);
  }
  return out;
}

int refuse(std::string_view why) {
  fmt::print(stderr, "skerry_compare_images: {}\n", why);
  return 2;
}

int compare_files(int count, char** arguments) {
  if (count != 3 && count != 4)
    return refuse("give REFERENCE.png ACTUAL.png and, if wanted, DIFFERENCE.png");
  const Result<platform::PngImage> expected = platform::read_png(arguments[1]);
  if (!expected) return refuse(expected.error().message);
  const Result<platform::PngImage> actual = platform::read_png(arguments[2]);
  if (!actual) return refuse(actual.error().message);
  if (expected->width != actual->width || expected->height != actual->height)
    return refuse(fmt::format("the reference has {}x{} pixels, the picture {}x{}", expected->width,
                              expected->height, actual->width, actual->height));
  const Comparison found = compared(*expected, *actual);
  fmt::print(
      "{{\"exact\": {}, \"alike\": {}, \"pixels\": {}, \"different\": {}, \"outliers\": {}, "
      "\"largest\": {}, \"bright\": {}}}\n",
      found.exact(), found.alike(), found.pixels, found.different, found.outliers, found.largest,
      found.bright);
  if (count == 4 && !found.exact()) {
    const platform::PixelView view{actual->width, actual->height, 3, found.difference};
    if (const Result<void> written = platform::write_png(arguments[3], view); !written)
      return refuse(written.error().message);
  }
  return found.alike() ? 0 : 1;
}

}  // namespace
}  // namespace skerry

int main(int count, char** arguments) {
  return skerry::compare_files(count, arguments);
}
