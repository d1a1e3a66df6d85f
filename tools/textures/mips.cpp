#include "tools/textures/mips.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

// Coverage after averaging takes few values, so many texels tie; the surroundings decide between
// them.
float rank_key(const Image& image, int x, int y) {
  float around = 0.0f;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) around += image.at(x + dx, y + dy).a;
  return image.at(x, y).a + around * (1.0f / 128.0f);
}

// Alpha bytes of a cut-out's mip: the `covered` texels that rank highest are at least 128, the
// others less.
std::vector<std::uint8_t> scaled_alpha(const Image& image, float share) {
  const int count = image.edge * image.edge;
  const int covered = static_cast<int>(std::floor(share * static_cast<float>(count) + 0.5f));
  std::vector<float> keys;
  for (int y = 0; y < image.edge; ++y)
    for (int x = 0; x < image.edge; ++x) keys.push_back(rank_key(image, x, y));
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return keys[a] > keys[b]; });
  // Without a covered texel all stay below the threshold.
  const float last =
      covered > 0 ? std::max(image.texels[order[covered - 1]].a, 1.0f / 256.0f) : 1.0f;
  std::vector<std::uint8_t> alpha(count);
  for (int rank = 0; rank < count; ++rank) {
    const std::uint8_t scaled = quantize(image.texels[order[rank]].a * 0.5f / last);
    alpha[order[rank]] =
        rank < covered ? std::max<std::uint8_t>(scaled, 128) : std::min<std::uint8_t>(scaled, 127);
  }
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
                  [](const Light& light) { return light.a == 0.0f || light.a == 1.0f; });
  std::vector<Mip> mips;
  for (std::size_t level = 0; level < images.size(); ++level) {
    const Image& image = images[level];
    const std::vector<std::uint8_t> alpha =
        is_cutout && level > 0 && share < 1.0f ? scaled_alpha(image, share) : plain_alpha(image);
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
