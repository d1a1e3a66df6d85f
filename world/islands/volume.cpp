#include "world/islands/volume.h"

#include <algorithm>

#include "engine/core/check.h"
#include "world/islands/world.h"
#include "world/mesh/mesh.h"

namespace skerry::world {
namespace {

constexpr int kBrick = BrickChunk::kBrickEdge;
constexpr std::size_t kBrickVoxels = std::size_t{kBrick} * kBrick * kBrick;

/// One brick's ids, z fastest, then x, then y.
void copy_brick(std::span<const BlockId> chunk, int x0, int y0, int z0,
                std::span<BlockId, kBrickVoxels> out) {
  auto* to = out.data();
  for (int y = 0; y < kBrick; ++y)
    for (int x = 0; x < kBrick; ++x, to += kBrick)
      std::copy_n(&chunk[voxel_index(x0 + x, y0 + y, z0)], kBrick, to);
}

}  // namespace

BrickChunk::BrickChunk(std::span<const BlockId> voxels) {
  SKERRY_ASSERT(voxels.size() == kChunkVoxels);
  std::array<BlockId, kBrickVoxels> brick;
  for (int y = 0; y < kChunkEdge; y += kBrick) {
    for (int x = 0; x < kChunkEdge; x += kBrick) {
      for (int z = 0; z < kChunkEdge; z += kBrick) {
        copy_brick(voxels, x, y, z, brick);
        const bool uniform = std::all_of(brick.begin(), brick.end(),
                                         [first = brick[0]](BlockId id) { return id == first; });
        std::uint32_t& entry = bricks_[brick_of(x, y, z)];
        entry = uniform ? brick[0] : kStored | static_cast<std::uint32_t>(voxels_.size());
        if (!uniform) voxels_.insert(voxels_.end(), brick.begin(), brick.end());
        empty_ = empty_ && uniform && brick[0] == kAir;
      }
    }
  }
  voxels_.shrink_to_fit();
}

Volume::Volume(IVec3 box_min, IVec3 box_max, Fill fill)
    : box_min_(box_min), box_max_(box_max), fill_(std::move(fill)) {
  SKERRY_ASSERT(box_min.x <= box_max.x && box_min.y <= box_max.y && box_min.z <= box_max.z);
  const auto chunks = [](std::int32_t low, std::int32_t high) {
    return low == high ? 0 : ((high - 1) >> 6) - (low >> 6) + 1;
  };
  first_ = {box_min.x >> 6, box_min.y >> 6, box_min.z >> 6};
  count_ = {chunks(box_min.x, box_max.x), chunks(box_min.y, box_max.y),
            chunks(box_min.z, box_max.z)};
  slots_ = std::make_unique<Slot[]>(static_cast<std::size_t>(count_.x) *
                                    static_cast<std::size_t>(count_.y) *
                                    static_cast<std::size_t>(count_.z));
}

Volume::~Volume() = default;

std::shared_ptr<const Volume> Volume::of_island(World& world, const IslandSpec& spec) {
  return std::make_shared<Volume>(spec.box_min, spec.box_max,
                                  [&world, id = spec.id](IVec3 chunk, std::span<BlockId> out) {
                                    thread_local std::vector<BlockId> padded(kPaddedVoxels);
                                    if (!world.generate_padded(id, chunk, 0, padded)) return false;
                                    chunk_from_padded(padded).unpack(out);
                                    return true;
                                  });
}

std::shared_ptr<const Volume> Volume::from_voxels(IVec3 box_min, IVec3 box_max,
                                                  const std::function<BlockId(IVec3)>& block_at) {
  return std::make_shared<Volume>(box_min, box_max, [=](IVec3 chunk, std::span<BlockId> out) {
    for (int y = 0; y < kChunkEdge; ++y) {
      for (int x = 0; x < kChunkEdge; ++x) {
        for (int z = 0; z < kChunkEdge; ++z) {
          const IVec3 v{chunk.x * 64 + x, chunk.y * 64 + y, chunk.z * 64 + z};
          const bool inside = v.x >= box_min.x && v.x < box_max.x && v.y >= box_min.y &&
                              v.y < box_max.y && v.z >= box_min.z && v.z < box_max.z;
          out[voxel_index(x, y, z)] = inside ? block_at(v) : kAir;
        }
      }
    }
    return true;
  });
}

BlockId Volume::block_at(IVec3 voxel) const {
  const BrickChunk* chunk = chunk_at(voxel);
  return chunk ? chunk->at(voxel.x & 63, voxel.y & 63, voxel.z & 63) : kAir;
}

const BrickChunk* Volume::make(Slot& slot, IVec3 place) const {
  const std::lock_guard lock(slot.making);
  if (slot.state.load(std::memory_order_relaxed) == kUnmade) {
    thread_local std::vector<BlockId> voxels(kChunkVoxels);
    const IVec3 chunk{first_.x + place.x, first_.y + place.y, first_.z + place.z};
    if (fill_(chunk, voxels)) slot.chunk = std::make_unique<const BrickChunk>(voxels);
    const bool empty = !slot.chunk || slot.chunk->empty();
    if (empty) slot.chunk.reset();
    chunks_made_.fetch_add(1, std::memory_order_relaxed);
    slot.state.store(empty ? kEmpty : kMade, std::memory_order_release);
  }
  return slot.chunk.get();
}

}  // namespace skerry::world
