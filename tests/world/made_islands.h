// Islands made by hand, for tests of what moves and breaks them.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "world/islands/stored_voxels.h"
#include "world/islands/world.h"
#include "world/voxel/edits.h"

namespace skerry::world {

/// A world whose only islands are those that a test adds.
inline WorldDesc empty_world() {
  WorldDesc desc;
  desc.generated = false;
  return desc;
}

inline std::map<IVec3, Chunk> chunks_from(const std::vector<IVec3>& voxels, BlockId block) {
  std::map<IVec3, std::vector<BlockId>> blocks;
  for (const IVec3& v : voxels)
    blocks.try_emplace(chunk_of(v), kChunkVoxels, kAir).first->second[index_in_chunk(v)] = block;
  std::map<IVec3, Chunk> chunks;
  for (const auto& [at, list] : blocks) chunks.emplace(at, Chunk::from_voxels(list));
  return chunks;
}

/// @return its id.
inline std::uint64_t add_island(World& world, WorldPos origin, const std::vector<IVec3>& voxels,
                                BlockId block = block::kStone) {
  const auto stored = std::make_shared<const StoredVoxels>(chunks_from(voxels, block));
  IslandSpec spec;
  spec.id = world.unused_id();
  spec.origin = origin;
  world.add_island(fitted(spec, *stored), stored);
  return spec.id;
}

/// All voxels of [low, high) that a test asks for.
inline std::vector<IVec3> voxels_in(IVec3 low, IVec3 high,
                                    const std::function<bool(IVec3)>& wanted = {}) {
  std::vector<IVec3> out;
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x)
      for (int z = low.z; z < high.z; ++z)
        if (!wanted || wanted({x, y, z})) out.push_back({x, y, z});
  return out;
}

inline WorldPos blocks(double x, double y, double z) {
  return moved({}, {x, y, z});
}

}  // namespace skerry::world
