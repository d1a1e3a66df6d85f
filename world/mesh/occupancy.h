#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "world/voxel/blocks.h"

namespace skerry::world {

/// Which voxels of a chunk are of one kind, mostly opaque, in the GPU's own words
/// (shaders/shared/occupancy.h), bricks numbered from 0.
struct ChunkOccupancy {
  enum class Fill : std::uint8_t { kEmpty, kFull, kMixed };
  Fill fill = Fill::kEmpty;
  std::vector<std::uint32_t> table;  ///< shared::kBricksPerChunk entries if mixed, else none
  std::vector<std::uint32_t> words;  ///< shared::kBrickWords for each brick that is stored
};

/// @param voxels kPaddedVoxels block ids, as mesh_chunk takes them; the shell is not looked at.
ChunkOccupancy occupancy_of(std::span<const BlockId> voxels, BlockKind kind = BlockKind::kOpaque);

}  // namespace skerry::world
