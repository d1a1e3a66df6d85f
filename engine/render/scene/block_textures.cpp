#include "engine/render/scene/block_textures.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "engine/core/check.h"
#include "engine/core/words.h"

// Begin and end of the file, placed in the program by cmake/textures.cmake.
extern "C" {
extern const std::byte skerry_block_textures[], skerry_block_textures_end[];
}

namespace skerry::render {
namespace {

constexpr std::uint32_t kMaxLayers =
    2048;  // what every desktop Vulkan device can hold in one image
constexpr std::uint32_t kMaxEdge = 1024;
constexpr std::size_t kTexelBytes = 4;

/// Of a byte of coverage: the half that shaders see.
std::array<std::uint16_t, 256> shares() {
  std::array<std::uint16_t, 256> out;
  for (std::size_t i = 0; i < 256; ++i) out[i] = glm::packHalf1x16(static_cast<float>(i) / 255.0f);
  return out;
}

}  // namespace

Result<BlockTextures> parse_block_textures(std::span<const std::byte> file) {
  if (file.size() < kBlockTexturesHeaderBytes || word_at(file, 0) != kBlockTexturesMagic) {
    return Error{
        "cannot read block textures: not a block texture file; build it with skerry_textures"};
  }
  if (word_at(file, 1) != kBlockTexturesVersion) {
    return Error{
        "cannot read block textures: another version of the format; build it with this program's "
        "skerry_textures"};
  }
  const std::uint32_t layers = word_at(file, 2), edge = word_at(file, 3);
  if (layers == 0 || layers > kMaxLayers || edge > kMaxEdge || !std::has_single_bit(edge)) {
    return Error{
        "cannot read block textures: impossible layer count or edge in the header; build the file "
        "again"};
  }
  std::size_t size_bytes = 0;
  for (std::size_t e = edge; e > 0; e /= 2) size_bytes += e * e * layers * kTexelBytes;
  const auto texels = file.subspan(kBlockTexturesHeaderBytes);
  if (texels.size() != size_bytes) {
    return Error{"cannot read block textures: the file is cut short or too long; build it again"};
  }
  return BlockTextures{edge, layers, static_cast<std::uint32_t>(std::bit_width(edge)), texels};
}

double linear_from_srgb(std::byte encoded) {
  const double value = std::to_integer<int>(encoded) / 255.0;
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

std::vector<std::byte> linear_texels(const BlockTextures& textures) {
  const std::array<std::uint16_t, 256> share = shares();
  std::array<std::uint16_t, 256> light;
  for (std::size_t i = 0; i < 256; ++i)
    light[i] = glm::packHalf1x16(static_cast<float>(linear_from_srgb(std::byte(i))));
  std::vector<std::byte> out(textures.texels.size() * sizeof(std::uint16_t));
  for (std::size_t i = 0; i < textures.texels.size(); ++i) {
    const auto byte = std::to_integer<std::size_t>(textures.texels[i]);
    const std::uint16_t half = i % kTexelBytes == 3 ? share[byte] : light[byte];
    std::memcpy(&out[i * sizeof half], &half, sizeof half);
  }
  return out;
}

std::vector<std::byte> coverage_texels(const BlockTextures& textures) {
  const std::array<std::uint16_t, 256> share = shares();
  std::vector<std::byte> out(textures.texels.size() / kTexelBytes * sizeof(std::uint16_t));
  for (std::size_t i = 0; i * kTexelBytes < textures.texels.size(); ++i) {
    const std::uint16_t half =
        share[std::to_integer<std::size_t>(textures.texels[i * kTexelBytes + kTexelBytes - 1])];
    std::memcpy(&out[i * sizeof half], &half, sizeof half);
  }
  return out;
}

BlockTextures block_textures() {
  const auto parsed = parse_block_textures({skerry_block_textures, skerry_block_textures_end});
  SKERRY_ASSERT(parsed && parsed->layers == kBlockTextureLayers);
  return *parsed;
}

}  // namespace skerry::render
