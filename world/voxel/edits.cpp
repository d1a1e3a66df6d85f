#include "world/voxel/edits.h"

#include <algorithm>

namespace skerry::world {
namespace {

bool before(const VoxelEdit& a, const VoxelEdit& b) {
  return a.index < b.index;
}

}  // namespace

void merge_edits(ChunkEdits& edits, std::span<const VoxelEdit> newer) {
  if (newer.size() == 1) {
    const auto at = std::lower_bound(edits.begin(), edits.end(), newer.front(), before);
    if (at != edits.end() && at->index == newer.front().index) {
      at->block = newer.front().block;
    } else {
      edits.insert(at, newer.front());
    }
    return;
  }
  ChunkEdits merged;
  merged.reserve(edits.size() + newer.size());
  // Of equal ones, set_union takes those of the first range.
  std::set_union(newer.begin(), newer.end(), edits.begin(), edits.end(), std::back_inserter(merged),
                 before);
  edits = std::move(merged);
}

std::optional<BlockId> edited_block(const ChunkEdits& edits, std::size_t index) {
  const VoxelEdit wanted{static_cast<std::uint32_t>(index), kAir};
  const auto at = std::lower_bound(edits.begin(), edits.end(), wanted, before);
  if (at == edits.end() || at->index != wanted.index) return std::nullopt;
  return at->block;
}

IVec3 chunk_of(IVec3 voxel) {
  const auto of = [](std::int32_t v) {
    return static_cast<std::int32_t>(floor_div(v, kChunkEdge));
  };
  return {of(voxel.x), of(voxel.y), of(voxel.z)};
}

std::size_t index_in_chunk(IVec3 voxel) {
  const auto in = [](std::int32_t v) { return static_cast<int>(floor_mod(v, kChunkEdge)); };
  return voxel_index(in(voxel.x), in(voxel.y), in(voxel.z));
}

}  // namespace skerry::world
