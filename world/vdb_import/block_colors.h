#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "world/voxel/blocks.h"

namespace skerry::world {

/// A block and the mean colour of its side's texture.
struct BlockColor {
  BlockId id;
  std::array<std::uint8_t, 3> srgb;
};

/// Blocks that a colour may become: solid, without light of their own. Public for the test that
/// compares them with the painted textures, which this room cannot see.
std::span<const BlockColor> block_colors();

/// The block whose colour is nearest, as the eye sees differences: distance in OKLab
/// (B. Ottosson, "A perceptual color space for image processing", 2020).
/// @param packed 65536 * r + 256 * g + b in sRGB, as VolumeKind::kColor packs it.
BlockId nearest_block(std::uint32_t packed);

}  // namespace skerry::world
