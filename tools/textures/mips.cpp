#include "tools/textures/mips.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace skerry::textures {
namespace {

// Linear light times coverage, and coverage.
struct Light {
  float r = 0, g = 0, b = 0, a = 0;
};
struct Image {
  int edge;
  std::vector<Light> texels;
  const Light& at(int x, int y) const {
    return texels[(x + edge) % edge + edge * ((y + edge) % edge)];
  }
};

Image first_image(const Canvas& canvas) {
  Image image{kEdge, {}};
  const auto linear = [](float coded) { return linear_from_srgb(quantize(coded)); };
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      const auto& [color, alpha] = canvas.at(x, y);
      image.texels.push_back(
          {linear(color.r) * alpha, linear(color.g) * alpha, linear(color.b) * alpha, alpha});
    }
  }
  return image;
}

Image half(const Image& fine) {
  Image coarse{fine.edge / 2, {}};
  for (int y = 0; y < coarse.edge; ++y) {
    for (int x = 0; x < coarse.edge; ++x) {
      Light sum;
      for (int i = 0; i < 4; ++i) {
        const Light& part = fine.at(2 * x + (i & 1), 2 * y + (i >> 1));
        sum = {sum.r + part.r, sum.g + part.g, sum.b + part.b, sum.a + part.a};
      }
      coarse.texels.push_back({sum.r * 0.25f, sum.g * 0.25f, sum.b * 0.25f, sum.a * 0.25f});
    }
  }
  return coarse;
}

// Coverage of a texel. Where equal texels tie, as in a lattice finer than them, an ordered pattern
// decides between them (B. Bayer, An Optimum Method for Two-Level Rendition, 1973).
float untied(const Image& image, int x, int y) {
  constexpr int kOrder[4] = {0, 2, 3, 1};
  const int wrapped_x = (x + image.edge) % image.edge, wrapped_y = (y + image.edge) % image.edge;
  const int fine = kOrder[(wrapped_x & 1) + 2 * (wrapped_y & 1)];
  const int coarse = kOrder[(wrapped_x >> 1 & 1) + 2 * (wrapped_y >> 1 & 1)];
  return image.at(x, y).a + static_cast<float>(4 * fine + coarse) * (1.0f / 1024.0f);
}

// What a bilinear filter makes of coverage at kLookups^2 even places of a texture that repeats.
std::vector<float> filtered_coverage(const Image& image) {
  constexpr int kLookups = 128;
  std::vector<float> out;
  const float per_lookup = static_cast<float>(image.edge) / kLookups;
  for (int j = 0; j < kLookups; ++j) {
    for (int i = 0; i < kLookups; ++i) {
      const float at_x = (static_cast<float>(i) + 0.5f) * per_lookup + 0.5f;
      const float at_y = (static_cast<float>(j) + 0.5f) * per_lookup + 0.5f;
      const int x = static_cast<int>(at_x) - 1, y = static_cast<int>(at_y) - 1;
      const float right = at_x - static_cast<float>(x + 1), low = at_y - static_cast<float>(y + 1);
      const float above = untied(image, x, y) * (1.0f - right) + untied(image, x + 1, y) * right;
      const float below =
          untied(image, x, y + 1) * (1.0f - right) + untied(image, x + 1, y + 1) * right;
      out.push_back(above * (1.0f - low) + below * low);
    }
  }
  return out;
}

// Alpha bytes of a cut-out's mip: the filter that reads them finds a half or more at a share of all
// places.
std::vector<std::uint8_t> scaled_alpha(const Image& image, float share) {
  std::vector<float> found = filtered_coverage(image);
  const auto rank = static_cast<std::ptrdiff_t>((1.0f - share) * static_cast<float>(found.size()));
  std::nth_element(found.begin(), found.begin() + rank, found.end());
  const float threshold = found[rank];
  // A straight line takes the threshold to a half and what is farthest from it to 0 or 1, so that
  // 8 bits are enough and filtering commutes with it.
  float farthest = 0.0f;
  for (int y = 0; y < image.edge; ++y)
    for (int x = 0; x < image.edge; ++x)
      farthest = std::max(farthest, std::fabs(untied(image, x, y) - threshold));
  std::vector<std::uint8_t> alpha;
  for (int y = 0; y < image.edge; ++y)
    for (int x = 0; x < image.edge; ++x)
      alpha.push_back(quantize(0.5f + 0.5f * (untied(image, x, y) - threshold) / farthest));
  return alpha;
}

std::vector<std::uint8_t> plain_alpha(const Image& image) {
  std::vector<std::uint8_t> alpha;
  for (const Light& light : image.texels) alpha.push_back(quantize(light.a));
  return alpha;
}

// Colour of a texel, from the first mip that has any coverage there.
Light visible_light(const std::vector<Image>& images, std::size_t level, int x, int y) {
  for (; level < images.size(); ++level, x /= 2, y /= 2) {
    const Light& light = images[level].at(x, y);
    if (light.a > 0.0f) return {light.r / light.a, light.g / light.a, light.b / light.a, light.a};
  }
  return {};
}

}  // namespace

std::vector<Mip> make_mips(const Canvas& canvas) {
  std::vector<Image> images{first_image(canvas)};
  while (images.back().edge > 1) images.push_back(half(images.back()));
  const float share = images.back().texels[0].a;
  const bool is_cutout =
      std::all_of(images[0].texels.begin(), images[0].texels.end(),
                  [](const Light& light) { return light.a == 0.0f || light.a == 1.0f; }) &&
      share > 0.0f && share < 1.0f;
  std::vector<Mip> mips;
  for (std::size_t level = 0; level < images.size(); ++level) {
    const Image& image = images[level];
    const std::vector<std::uint8_t> alpha =
        is_cutout && level > 0 && image.edge > 1 ? scaled_alpha(image, share) : plain_alpha(image);
    Mip mip{image.edge, {}};
    for (int y = 0; y < image.edge; ++y) {
      for (int x = 0; x < image.edge; ++x) {
        const Light light = visible_light(images, level, x, y);
        mip.rgba.insert(mip.rgba.end(), {srgb_from_linear(light.r), srgb_from_linear(light.g),
                                         srgb_from_linear(light.b), alpha[x + image.edge * y]});
      }
    }
    mips.push_back(std::move(mip));
  }
  return mips;
}

}  // namespace skerry::textures
