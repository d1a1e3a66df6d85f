#include "world/vdb_import/block_colors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tools/textures/layers.h"

namespace skerry::world {
namespace {

double linear(double coded) {
  return coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4);
}

double coded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

/// Mean light of what is painted of a texture, as an 8-bit sRGB colour.
std::array<double, 3> mean_of(const textures::Canvas& canvas) {
  std::array<double, 3> sum{};
  double count = 0.0;
  for (int y = 0; y < textures::kEdge; ++y) {
    for (int x = 0; x < textures::kEdge; ++x) {
      const textures::Canvas::Texel& texel = canvas.at(x, y);
      if (texel.alpha < 0.5f) continue;
      const textures::Color& c = texel.color;
      sum[0] += linear(static_cast<double>(c.r));
      sum[1] += linear(static_cast<double>(c.g));
      sum[2] += linear(static_cast<double>(c.b));
      count += 1.0;
    }
  }
  for (double& channel : sum) channel = 255.0 * coded(channel / count);
  return sum;
}

TEST(BlockColors, AreTheMeansOfTheTextures) {
  const std::vector<textures::Layer> layers = textures::paint_layers();
  std::set<BlockId> seen;
  for (const BlockColor& color : block_colors()) {
    const BlockType& type = block_types()[color.id];
    EXPECT_TRUE(is_solid(color.id)) << type.name;
    EXPECT_EQ(type.emission, 0.0f) << type.name;
    EXPECT_TRUE(seen.insert(color.id).second) << type.name;
    const auto mean = mean_of(layers[static_cast<std::size_t>(type.side)].canvas);
    for (std::size_t channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(color.srgb[channel], mean[channel], 1.5) << type.name;
  }
}

TEST(BlockColors, ABlocksOwnColourFindsIt) {
  for (const BlockColor& color : block_colors()) {
    const std::uint32_t packed = static_cast<std::uint32_t>(color.srgb[0]) << 16 |
                                 static_cast<std::uint32_t>(color.srgb[1]) << 8 | color.srgb[2];
    EXPECT_EQ(nearest_block(packed), color.id) << block_types()[color.id].name;
  }
}

}  // namespace
}  // namespace skerry::world
