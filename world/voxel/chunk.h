#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "world/voxel/blocks.h"

namespace skerry::world {

inline constexpr int kChunkEdge = 64;
inline constexpr std::size_t kChunkVoxels = std::size_t{kChunkEdge} * kChunkEdge * kChunkEdge;

/// Index of a voxel in a chunk: z fastest, y slowest (docs/conventions.md). @pre 0 <= x, y, z < 64.
constexpr std::size_t voxel_index(int x, int y, int z) {
  return static_cast<std::size_t>(z) + static_cast<std::size_t>(x) * kChunkEdge +
         static_cast<std::size_t>(y) * kChunkEdge * kChunkEdge;
}

/// 64^3 block ids. A uniform chunk stores one id; others store a palette and indices of 1, 2, 4 or
/// 8 bits; with more than 256 ids, 16 bits a voxel hold the ids themselves.
class Chunk {
 public:
  /// A chunk filled with one id.
  explicit Chunk(BlockId fill = kAir);
  /// @param voxels kChunkVoxels ids in voxel_index order. Picks the smallest storage.
  static Chunk from_voxels(std::span<const BlockId> voxels);

  BlockId at(int x, int y, int z) const { return at(voxel_index(x, y, z)); }
  BlockId at(std::size_t index) const;
  /// Amortised O(1): at most four repacks as the palette grows.
  void set(int x, int y, int z, BlockId id);
  bool is_uniform() const { return bits_ == 0; }
  /// Ids in use, at least those present; index order is the storage's.
  std::span<const BlockId> palette() const;
  /// @param out kChunkVoxels ids in voxel_index order.
  void unpack(std::span<BlockId> out) const;
  /// Heap and object bytes this chunk takes.
  std::size_t size_bytes() const;

 private:
  void widen();  // makes room for one more palette entry

  int bits_ = 0;                      // bits an index: 0 (uniform), 1, 2, 4, 8, 16
  std::vector<BlockId> palette_;      // one entry when uniform, none at 16 bits
  std::vector<std::uint64_t> words_;  // indices, packed low bits first; empty when uniform
};

}  // namespace skerry::world
