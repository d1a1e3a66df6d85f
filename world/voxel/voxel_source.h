#pragma once
#include <span>
#include <vector>

#include "world/voxel/blocks.h"
#include "world/voxel/coords.h"

namespace skerry::world {

inline constexpr int kLevelCount = 5;  ///< levels of detail 0..4

/// Where an island's voxels come from before anyone edits them. Immutable: equal questions have
/// equal answers, on any thread.
class VoxelSource {
 public:
  virtual ~VoxelSource() = default;

  /// Chunks at a level, 0..4, that can hold anything but air. Order: y, then x, then z.
  virtual std::vector<IVec3> chunks(int level) const = 0;

  /// Voxels of one chunk with its one-voxel shell.
  /// @param chunk chunk coordinate at this level (docs/conventions.md).
  /// @param level a voxel's edge is 2^level blocks, 0..4.
  /// @param out 66^3 ids, index z + 66 x + 66^2 y, position (0,0,0) is voxel (-1,-1,-1) of the
  /// chunk. Filled either way.
  /// @return false when all of out is air.
  virtual bool generate_padded(IVec3 chunk, int level, std::span<BlockId> out) const = 0;
};

}  // namespace skerry::world
