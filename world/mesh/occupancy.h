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
  bool operator==(const ChunkOccupancy&) const = default;
};

/// @param voxels kPaddedVoxels block ids, as mesh_chunk takes them; the shell is not looked at.
ChunkOccupancy occupancy_of(std::span<const BlockId> voxels, BlockKind kind = BlockKind::kOpaque);

/// A voxel of stained glass.
struct StainedVoxel {
  std::uint32_t place = 0;  ///< in its chunk: bits 0-5 z, 6-11 x, 12-17 y
  BlockId block = kAir;
  bool operator==(const StainedVoxel&) const = default;
};
/// Those of a chunk, ascending by place. @param voxels as occupancy_of() takes them.
std::vector<StainedVoxel> stained_voxels_of(std::span<const BlockId> voxels);

}  // namespace skerry::world
