#include "world/islands/stored_voxels.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "engine/core/check.h"
#include "world/mesh/mesh.h"

namespace skerry::world {
namespace {

constexpr int kHalf = kChunkEdge / 2;

using Chunks = std::map<IVec3, Chunk>;

/// The most common block of four; air counts for nothing, ties go to the lower id.
BlockId most_common(const std::array<BlockId, 4>& blocks) {
  BlockId best = kAir;
  std::ptrdiff_t most = 0;
  for (const BlockId block : blocks) {
    if (block == kAir) continue;
    const std::ptrdiff_t count = std::count(blocks.begin(), blocks.end(), block);
    if (count < most || (count == most && block > best)) continue;
    best = block;
    most = count;
  }
  return best;
}

/// What stands for the eight voxels of [2x, 2x + 2) and so on.
BlockId coarse_block(std::span<const BlockId> fine, int x, int y, int z) {
  std::array<std::array<BlockId, 4>, 2> layers;
  int filled = 0;
  for (int dy = 0; dy < 2; ++dy) {
    for (int i = 0; i < 4; ++i) {
      const BlockId block = fine[voxel_index(2 * x + i / 2, 2 * y + dy, 2 * z + i % 2)];
      layers[dy][i] = block;
      filled += block != kAir;
    }
  }
  if (filled < 4) return kAir;
  const BlockId upper = most_common(layers[1]);
  return upper != kAir ? upper : most_common(layers[0]);
}

Chunks coarsened(const Chunks& fine) {
  std::map<IVec3, std::vector<BlockId>> made;
  std::vector<BlockId> voxels(kChunkVoxels);
  for (const auto& [at, chunk] : fine) {
    chunk.unpack(voxels);
    const IVec3 to{at.x >> 1, at.y >> 1, at.z >> 1};
    std::vector<BlockId>& out = made.try_emplace(to, kChunkVoxels, kAir).first->second;
    const IVec3 low{(at.x & 1) * kHalf, (at.y & 1) * kHalf, (at.z & 1) * kHalf};
    for (int y = 0; y < kHalf; ++y)
      for (int x = 0; x < kHalf; ++x)
        for (int z = 0; z < kHalf; ++z)
          out[voxel_index(low.x + x, low.y + y, low.z + z)] = coarse_block(voxels, x, y, z);
  }
  Chunks coarse;
  for (const auto& [at, out] : made) {
    Chunk chunk = Chunk::from_voxels(out);
    if (!chunk.is_uniform() || chunk.at(0) != kAir) coarse.emplace(at, std::move(chunk));
  }
  return coarse;
}

/// Voxels along one axis of a padded chunk that lie in the neighbour `step` away, and where they
/// are in that neighbour.
struct Overlap {
  int padded, inside, count;
};
Overlap overlap(int step) {
  if (step < 0) return {0, kChunkEdge - 1, 1};
  if (step > 0) return {kChunkEdge + 1, 0, 1};
  return {1, 0, kChunkEdge};
}

void copy_into(const Chunk& chunk, IVec3 step, std::span<BlockId> padded) {
  const Overlap ox = overlap(step.x), oy = overlap(step.y), oz = overlap(step.z);
  thread_local std::vector<BlockId> voxels(kChunkVoxels);
  const bool whole = step == IVec3{};
  if (whole) chunk.unpack(voxels);
  for (int y = 0; y < oy.count; ++y) {
    for (int x = 0; x < ox.count; ++x) {
      const std::size_t from = voxel_index(ox.inside + x, oy.inside + y, oz.inside);
      const std::size_t to = static_cast<std::size_t>(
          oz.padded + kPaddedEdge * (ox.padded + x + kPaddedEdge * (oy.padded + y)));
      for (std::size_t z = 0; z < static_cast<std::size_t>(oz.count); ++z)
        padded[to + z] = whole ? voxels[from + z] : chunk.at(from + z);
    }
  }
}

}  // namespace

StoredVoxels::StoredVoxels(Chunks chunks) {
  std::erase_if(chunks, [](const auto& entry) {
    return entry.second.is_uniform() && entry.second.at(0) == kAir;
  });
  levels_[0] = std::move(chunks);
}

StoredVoxels::~StoredVoxels() = default;

const Chunks& StoredVoxels::level(int level) const {
  SKERRY_ASSERT(level >= 0 && level < kLevelCount);
  if (level > 0) {
    std::call_once(made_[level],
                   [&] { levels_[level] = coarsened(StoredVoxels::level(level - 1)); });
  }
  return levels_[level];
}

std::vector<IVec3> StoredVoxels::chunks(int at) const {
  std::vector<IVec3> list;
  for (const auto& [chunk, voxels] : level(at)) list.push_back(chunk);
  std::sort(list.begin(), list.end(), [](const IVec3& a, const IVec3& b) {
    return std::tie(a.y, a.x, a.z) < std::tie(b.y, b.x, b.z);
  });
  return list;
}

bool StoredVoxels::generate_padded(IVec3 chunk, int at, std::span<BlockId> out) const {
  SKERRY_ASSERT(out.size() == kPaddedVoxels);
  std::fill(out.begin(), out.end(), kAir);
  const Chunks& chunks = level(at);
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dz = -1; dz <= 1; ++dz) {
        const auto found = chunks.find({chunk.x + dx, chunk.y + dy, chunk.z + dz});
        if (found != chunks.end()) copy_into(found->second, {dx, dy, dz}, out);
      }
    }
  }
  return std::any_of(out.begin(), out.end(), [](BlockId block) { return block != kAir; });
}

IslandSpec fitted(IslandSpec spec, const StoredVoxels& voxels) {
  SKERRY_ASSERT(!voxels.stored().empty());
  spec.box_min = {INT32_MAX, INT32_MAX, INT32_MAX};
  spec.box_max = {INT32_MIN, INT32_MIN, INT32_MIN};
  std::vector<BlockId> blocks(kChunkVoxels);
  for (const auto& [at, chunk] : voxels.stored()) {
    chunk.unpack(blocks);
    for (int i = 0; i < static_cast<int>(kChunkVoxels); ++i) {
      if (blocks[static_cast<std::size_t>(i)] == kAir) continue;
      const IVec3 v{at.x * kChunkEdge + i / kChunkEdge % kChunkEdge,
                    at.y * kChunkEdge + i / (kChunkEdge * kChunkEdge),
                    at.z * kChunkEdge + i % kChunkEdge};
      include(spec, v);
    }
  }
  spec.bounding_radius = radius_of(spec);
  return spec;
}

}  // namespace skerry::world
