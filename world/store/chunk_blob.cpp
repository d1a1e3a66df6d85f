#include "world/store/chunk_blob.h"

#include <zstd.h>

#include "engine/core/check.h"
#include "world/store/bytes.h"

namespace skerry::world {
namespace {

constexpr std::uint32_t kMagicEdits = 0x31456b53;  // "SkE1"
constexpr std::uint32_t kMagicWhole = 0x31576b53;  // "SkW1"
constexpr std::size_t kHeaderBytes = 16;
constexpr std::size_t kEditBytes = 6, kBlockBytes = 2;
// Beyond 3, levels cost more time than they save bytes on voxels.
constexpr int kLevel = 3;

std::uint64_t checksum_of(const ChunkName& name, std::span<const std::byte> payload) {
  ByteWriter key;
  key.u64(name.island);
  for (const std::int32_t axis : {name.chunk.x, name.chunk.y, name.chunk.z})
    key.u32(static_cast<std::uint32_t>(axis));
  return checksum(payload, checksum(key.bytes()));
}

std::vector<std::byte> pack(std::uint32_t magic, const ChunkName& name,
                            std::span<const std::byte> payload) {
  ByteWriter header;
  header.u32(magic);
  header.u32(static_cast<std::uint32_t>(payload.size()));
  header.u64(checksum_of(name, payload));
  std::vector<std::byte> blob = header.take();
  blob.resize(kHeaderBytes + ZSTD_compressBound(payload.size()));
  const std::size_t size = ZSTD_compress(blob.data() + kHeaderBytes, blob.size() - kHeaderBytes,
                                         payload.data(), payload.size(), kLevel);
  SKERRY_ASSERT(!ZSTD_isError(size));  // the bound is the library's own
  blob.resize(kHeaderBytes + size);
  return blob;
}

Result<std::vector<std::byte>> unpack(std::uint32_t magic, const ChunkName& name,
                                      std::span<const std::byte> blob, std::size_t most) {
  if (blob.size() < kHeaderBytes) return Error{"it is too short"};
  ByteReader header(blob.first(kHeaderBytes));
  if (header.u32() != magic) return Error{"it is no such chunk"};
  const std::size_t size = header.u32();
  const std::uint64_t expected = header.u64();
  if (size > most) return Error{"it claims to be too large"};
  const std::span<const std::byte> packed = blob.subspan(kHeaderBytes);
  if (ZSTD_getFrameContentSize(packed.data(), packed.size()) != size)
    return Error{"its sizes disagree"};
  std::vector<std::byte> payload(size);
  const std::size_t got = ZSTD_decompress(payload.data(), size, packed.data(), packed.size());
  if (ZSTD_isError(got) || got != size) return Error{"it does not decompress"};
  if (checksum_of(name, payload) != expected) return Error{"its checksum is wrong"};
  return payload;
}

}  // namespace

std::vector<std::byte> encode_edits(const ChunkName& name, std::span<const VoxelEdit> edits) {
  SKERRY_ASSERT(edits.size() <= kChunkVoxels);
  ByteWriter payload;
  std::uint32_t last = 0;
  for (const VoxelEdit& edit : edits) {
    payload.u32(edit.index - last);
    last = edit.index;
  }
  for (const VoxelEdit& edit : edits) payload.u16(edit.block);
  return pack(kMagicEdits, name, payload.bytes());
}

std::vector<std::byte> encode_chunk(const ChunkName& name, const Chunk& chunk) {
  std::vector<BlockId> blocks(kChunkVoxels);
  chunk.unpack(blocks);
  std::vector<std::byte> payload(kChunkVoxels * kBlockBytes);
  for (std::size_t i = 0; i < kChunkVoxels; ++i) {
    payload[2 * i] = static_cast<std::byte>(blocks[i] & 0xff);
    payload[2 * i + 1] = static_cast<std::byte>(blocks[i] >> 8);
  }
  return pack(kMagicWhole, name, payload);
}

Result<ChunkEdits> decode_edits(const ChunkName& name, std::span<const std::byte> blob) {
  const auto payload = unpack(kMagicEdits, name, blob, kChunkVoxels * kEditBytes);
  if (!payload) return payload.error();
  if (payload->size() % kEditBytes != 0) return Error{"its length fits no edits"};
  ByteReader reader(*payload);
  ChunkEdits edits(payload->size() / kEditBytes);
  std::uint64_t index = 0;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    const std::uint32_t step = reader.u32();
    if (i != 0 && step == 0) return Error{"a voxel stands in it twice"};
    index += step;
    if (index >= kChunkVoxels) return Error{"a voxel lies outside its chunk"};
    edits[i].index = static_cast<std::uint32_t>(index);
  }
  for (VoxelEdit& edit : edits) {
    edit.block = reader.u16();
    if (edit.block >= block::kBuiltInCount) return Error{"a block is unknown"};
  }
  return edits;
}

Result<Chunk> decode_chunk(const ChunkName& name, std::span<const std::byte> blob) {
  const auto payload = unpack(kMagicWhole, name, blob, kChunkVoxels * kBlockBytes);
  if (!payload) return payload.error();
  if (payload->size() != kChunkVoxels * kBlockBytes) return Error{"its length fits no chunk"};
  std::vector<BlockId> blocks(kChunkVoxels);
  for (std::size_t i = 0; i < kChunkVoxels; ++i) {
    blocks[i] = static_cast<BlockId>(std::to_integer<unsigned>((*payload)[2 * i]) |
                                     std::to_integer<unsigned>((*payload)[2 * i + 1]) << 8);
    if (blocks[i] >= block::kBuiltInCount) return Error{"a block is unknown"};
  }
  return Chunk::from_voxels(blocks);
}

}  // namespace skerry::world
