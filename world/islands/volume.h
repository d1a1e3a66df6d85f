#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "world/voxel/chunk.h"
#include "world/voxel/coords.h"
#include "world/voxel/island.h"

namespace skerry::world {

class World;

/// One chunk's voxels as 8^3 bricks, so that a ray crosses what is empty in long steps.
class BrickChunk {
 public:
  static constexpr int kBrickEdge = 8;
  /// @param voxels kChunkVoxels ids in voxel_index order.
  explicit BrickChunk(std::span<const BlockId> voxels);

  /// The id that fills the whole brick of a voxel, or kMixed.
  static constexpr std::uint32_t kMixed = 0xffff'ffff;
  std::uint32_t uniform_id(int x, int y, int z) const {
    const std::uint32_t entry = bricks_[brick_of(x, y, z)];
    return (entry & kStored) != 0 ? kMixed : entry;
  }
  BlockId at(int x, int y, int z) const {
    const std::uint32_t entry = bricks_[brick_of(x, y, z)];
    if ((entry & kStored) == 0) return static_cast<BlockId>(entry);
    const int inside = (z & 7) | (x & 7) << 3 | (y & 7) << 6;
    return voxels_[(entry & ~kStored) + static_cast<std::uint32_t>(inside)];
  }
  bool empty() const { return empty_; }

 private:
  static constexpr std::uint32_t kStored = 0x8000'0000;
  static std::size_t brick_of(int x, int y, int z) {
    return static_cast<std::size_t>(z >> 3 | (x >> 3) << 3 | (y >> 3) << 6);
  }

  std::array<std::uint32_t, 512> bricks_{};  // an id, or kStored and where its voxels begin
  std::vector<BlockId> voxels_;
  bool empty_ = true;
};

/// What a ray meets at a voxel: `id` fills the cube of `size` voxels, aligned to it, around there.
struct MarchCell {
  int size = 1;  ///< a power of two; over 1 only of air
  BlockId id = kAir;
};

/// The voxels of one lattice, made chunk by chunk when a ray first comes there. Safe on any thread.
class Volume {
 public:
  /// Fills a chunk: kChunkVoxels ids in voxel_index order. Must give the same ids
  /// whenever it is asked, from any thread. @return false: all air, `out` is not looked at.
  using Fill = std::function<bool(IVec3 chunk, std::span<BlockId> out)>;

  /// @param box_min, box_max voxels outside [min, max) are air.
  Volume(IVec3 box_min, IVec3 box_max, Fill fill);
  /// An island at full detail, edits included as they are when a chunk is first come to.
  /// @param world outlives the volume.
  static std::shared_ptr<const Volume> of_island(World& world, const IslandSpec& spec);
  /// From a function of the voxel. For small scenes made by hand.
  static std::shared_ptr<const Volume> from_voxels(IVec3 box_min, IVec3 box_max,
                                                   const std::function<BlockId(IVec3)>& block_at);
  ~Volume();
  Volume(const Volume&) = delete;
  Volume& operator=(const Volume&) = delete;

  IVec3 box_min() const { return box_min_; }
  IVec3 box_max() const { return box_max_; }
  /// The chunk that holds a voxel; nullptr: it holds nothing but air.
  const BrickChunk* chunk_at(IVec3 voxel) const {
    const int x = (voxel.x >> 6) - first_.x, y = (voxel.y >> 6) - first_.y,
              z = (voxel.z >> 6) - first_.z;
    if (x < 0 || y < 0 || z < 0 || x >= count_.x || y >= count_.y || z >= count_.z) return nullptr;
    Slot& slot = slots_[static_cast<std::size_t>(z + count_.z * (x + count_.x * y))];
    const int state = slot.state.load(std::memory_order_acquire);
    if (state == kEmpty) return nullptr;
    return state == kMade ? slot.chunk.get() : make(slot, {x, y, z});
  }
  BlockId block_at(IVec3 voxel) const;
  /// For march().
  MarchCell cell_at(IVec3 voxel) const {
    const BrickChunk* chunk = chunk_at(voxel);
    if (!chunk) return {kChunkEdge, kAir};
    const int x = voxel.x & 63, y = voxel.y & 63, z = voxel.z & 63;
    const std::uint32_t uniform = chunk->uniform_id(x, y, z);
    if (uniform == BrickChunk::kMixed) return {1, chunk->at(x, y, z)};
    return {uniform == kAir ? BrickChunk::kBrickEdge : 1, static_cast<BlockId>(uniform)};
  }
  /// Chunks asked for so far, empty ones included.
  std::size_t chunks_made() const { return chunks_made_.load(std::memory_order_relaxed); }

 private:
  enum : int { kUnmade, kEmpty, kMade };
  struct Slot {
    std::atomic<int> state = kUnmade;
    std::mutex making;
    std::unique_ptr<const BrickChunk> chunk;
  };
  const BrickChunk* make(Slot& slot, IVec3 place) const;

  const IVec3 box_min_, box_max_;
  IVec3 first_, count_;  // chunks
  const Fill fill_;
  std::unique_ptr<Slot[]> slots_;
  mutable std::atomic<std::size_t> chunks_made_ = 0;
};

}  // namespace skerry::world
