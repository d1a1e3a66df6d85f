#include "tools/measure/image.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/core/check.h"
#include "engine/platform/image_file.h"
#include "tools/measure/color.h"

namespace skerry::measure {
namespace {

std::uint8_t byte_of(double encoded) {
  const double clamped = encoded > 0.0 ? std::min(encoded, 1.0) : 0.0;
  return static_cast<std::uint8_t>(std::lround(clamped * 255.0));
}

void append(Image& image, const glm::vec3& linear) {
  for (int c = 0; c < 3; ++c)
    image.rgba.push_back(byte_of(srgb_from_linear(static_cast<double>(linear[c]))));
  image.rgba.push_back(255);
}

}  // namespace

Picture picture_from(const Image& image) {
  const std::array<float, 256>& linear = linear_of_bytes();
  const std::vector<std::uint8_t>& rgba = image.rgba;
  Picture out{image.width, image.height, std::vector<glm::vec3>(rgba.size() / 4)};
  for (std::size_t i = 0; i < out.pixels.size(); ++i)
    out.pixels[i] = {linear[rgba[4 * i]], linear[rgba[4 * i + 1]], linear[rgba[4 * i + 2]]};
  return out;
}

std::array<std::uint8_t, 3> heat_color(double error) {
  // sRGB knots picked so that their L* are about 0, 20, 40, 60, 80 and 100.
  static constexpr double kKnots[6][3] = {{0.000, 0.000, 0.000}, {0.180, 0.110, 0.440},
                                          {0.580, 0.170, 0.480}, {0.930, 0.390, 0.280},
                                          {0.990, 0.750, 0.340}, {1.000, 1.000, 1.000}};
  const double at = 5.0 * (error > 0.0 ? std::min(error, 1.0) : 0.0);
  const int low = std::min(static_cast<int>(at), 4);
  std::array<std::uint8_t, 3> color{};
  for (std::size_t c = 0; c < 3; ++c)
    color[c] = byte_of(kKnots[low][c] + (at - low) * (kKnots[low + 1][c] - kKnots[low][c]));
  return color;
}

Image heat_map(const ErrorMap& map) {
  Image out{map.width, map.height, {}};
  out.rgba.reserve(map.errors.size() * 4);
  for (const float error : map.errors) {
    const std::array<std::uint8_t, 3> color = heat_color(error);
    out.rgba.insert(out.rgba.end(), {color[0], color[1], color[2], 255});
  }
  return out;
}

Image amplified_difference(const Image& a, const Image& b, int gain) {
  SKERRY_ASSERT(a.width == b.width && a.height == b.height && a.rgba.size() == b.rgba.size());
  Image out{a.width, a.height, a.rgba};
  for (std::size_t i = 0; i < out.rgba.size(); ++i) {
    const int difference = std::abs(int{a.rgba[i]} - int{b.rgba[i]});
    out.rgba[i] = i % 4 == 3 ? std::uint8_t{255}
                             : static_cast<std::uint8_t>(std::min(gain * difference, 255));
  }
  return out;
}

Image shrink(const Image& image, std::uint32_t factor) {
  SKERRY_ASSERT(factor >= 1);
  const Picture picture = picture_from(image);
  Image out{(image.width + factor - 1) / factor, (image.height + factor - 1) / factor, {}};
  for (std::uint32_t y = 0; y < image.height; y += factor) {
    for (std::uint32_t x = 0; x < image.width; x += factor) {
      glm::vec3 sum(0.0f);
      const std::uint32_t bottom = std::min(y + factor, image.height);
      const std::uint32_t right = std::min(x + factor, image.width);
      for (std::uint32_t v = y; v < bottom; ++v)
        for (std::uint32_t u = x; u < right; ++u)
          sum += picture.pixels[std::size_t{v} * image.width + u];
      append(out, sum / static_cast<float>((bottom - y) * (right - x)));
    }
  }
  return out;
}

Result<void> write_image(const std::filesystem::path& path, const Image& image) {
  return platform::write_png(path, {image.width, image.height, 4, image.rgba});
}

}  // namespace skerry::measure
