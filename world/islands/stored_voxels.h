#pragma once
#include <array>
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "world/voxel/chunk.h"
#include "world/voxel/island.h"
#include "world/voxel/voxel_source.h"

namespace skerry::world {

/// Voxels that are kept rather than generated: imported, or broken off another island.
class StoredVoxels final : public VoxelSource {
 public:
  /// @param chunks of level 0; those that are plain air are dropped.
  explicit StoredVoxels(std::map<IVec3, Chunk> chunks);
  ~StoredVoxels() override;

  /// A coarse voxel is filled if at least half of its eight finer ones are, with the block that is
  /// most common among the upper ones: what is seen from above keeps its colour. Coarse levels are
  /// made when first asked for.
  std::vector<IVec3> chunks(int level) const override;
  bool generate_padded(IVec3 chunk, int level, std::span<BlockId> out) const override;

  /// Chunks of level 0.
  const std::map<IVec3, Chunk>& stored() const { return levels_[0]; }

 private:
  const std::map<IVec3, Chunk>& level(int level) const;

  mutable std::array<std::map<IVec3, Chunk>, kLevelCount> levels_;
  mutable std::array<std::once_flag, kLevelCount> made_;
};

/// A spec with the box and the radius of the voxels. @pre there is at least one block.
IslandSpec fitted(IslandSpec spec, const StoredVoxels& voxels);

}  // namespace skerry::world
