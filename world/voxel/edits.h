#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "world/voxel/blocks.h"
#include "world/voxel/chunk.h"
#include "world/voxel/coords.h"

namespace skerry::world {

/// A block that stands in place of what the island's source has there.
struct VoxelEdit {
  std::uint32_t index = 0;  ///< voxel_index, < kChunkVoxels
  BlockId block = kAir;
  bool operator==(const VoxelEdit&) const = default;
};

/// What was changed in a chunk of level 0: ascending indices, none twice.
using ChunkEdits = std::vector<VoxelEdit>;

/// Adds newer edits to older ones. @param newer ascending indices.
void merge_edits(ChunkEdits& edits, std::span<const VoxelEdit> newer);
/// The block an edit puts at a voxel, if one does.
std::optional<BlockId> edited_block(const ChunkEdits& edits, std::size_t index);

/// The place of an index in its chunk, each axis 0 .. kChunkEdge - 1.
constexpr IVec3 place_in_chunk(std::uint32_t index) {
  return {static_cast<std::int32_t>(index / kChunkEdge % kChunkEdge),
          static_cast<std::int32_t>(index / (kChunkEdge * kChunkEdge)),
          static_cast<std::int32_t>(index % kChunkEdge)};
}
/// The lattice voxel of an index in a chunk.
constexpr IVec3 voxel_of(IVec3 chunk, std::uint32_t index) {
  const IVec3 in = place_in_chunk(index);
  return {chunk.x * kChunkEdge + in.x, chunk.y * kChunkEdge + in.y, chunk.z * kChunkEdge + in.z};
}

/// Chunk that holds a voxel, and the voxel's place in it.
IVec3 chunk_of(IVec3 voxel);
std::size_t index_in_chunk(IVec3 voxel);

}  // namespace skerry::world
