#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/result.h"

namespace skerry::render {

// The file that tools/textures writes: a header of four little-endian uint32 (magic, version,
// layers, edge), then RGBA8 texels, sRGB colour and linear coverage: mip by mip from edge down to
// 1, the layers in order within a mip, row 0 on top. docs/textures.md lists the layers.
inline constexpr std::uint32_t kBlockTexturesMagic = 0x58544b53;  // "SKTX"
inline constexpr std::uint32_t kBlockTexturesVersion = 1;
inline constexpr std::uint32_t kBlockTextureLayers = 256;
inline constexpr std::size_t kBlockTexturesHeaderBytes = 16;

/// A block texture array in memory.
struct BlockTextures {
  std::uint32_t edge;  ///< of mip 0 [texels], a power of two
  std::uint32_t layers;
  std::uint32_t mips;  ///< log2(edge) + 1
  std::span<const std::byte>
      texels;  ///< everything after the header, as gpu::Uploader::fill_image takes it
};

/// Linear light of a byte of sRGB, 0..1 (IEC 61966-2-1).
double linear_from_srgb(std::byte encoded);

/// Checks a file's header and size. The result points into `file`.
/// @return an Error if it is no block texture file, of another version, or of another size than its
/// header says.
Result<BlockTextures> parse_block_textures(std::span<const std::byte> file);

/// The texels as shaders sample them: four halves each, linear light and coverage, in the same
/// order. Drivers decode sRGB formats differently, by up to half a code value; halves they all
/// filter alike.
std::vector<std::byte> linear_texels(const BlockTextures& textures);

/// Their coverage alone, one half each, equal to the last of linear_texels(): cut-outs ask for
/// nothing else, and a CPU device filters all channels that a format has.
std::vector<std::byte> coverage_texels(const BlockTextures& textures);

/// The textures embedded in the program, kBlockTextureLayers layers.
BlockTextures block_textures();

}  // namespace skerry::render
