// A chunk as bytes of a world file.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/result.h"
#include "world/voxel/chunk.h"
#include "world/voxel/edits.h"

namespace skerry::world {

/// Which chunk some bytes are of. Bytes that were moved to another place do not decode there.
struct ChunkName {
  std::uint64_t island = 0;
  IVec3 chunk;  ///< of level 0
  auto operator<=>(const ChunkName&) const = default;
};

/// Layout, little-endian: u32 kMagicEdits or kMagicWhole; u32 size of the payload; u64 checksum of
/// name and payload; the payload, compressed by zstd. Payload of edits: their indices, each u32
/// less the one before, then their blocks, u16 each. Of a whole chunk: kChunkVoxels blocks, u16
/// each.
std::vector<std::byte> encode_edits(const ChunkName& name, std::span<const VoxelEdit> edits);
std::vector<std::byte> encode_chunk(const ChunkName& name, const Chunk& chunk);

/// What such bytes hold, for any bytes. Errors, without a name: what about them is wrong.
Result<ChunkEdits> decode_edits(const ChunkName& name, std::span<const std::byte> blob);
Result<Chunk> decode_chunk(const ChunkName& name, std::span<const std::byte> blob);

}  // namespace skerry::world
