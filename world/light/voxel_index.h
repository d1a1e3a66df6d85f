#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "world/light/air_volume.h"

namespace skerry::world {

/// Numbers some voxels of a box from 0 on, in the order of its rows.
class VoxelIndex {
 public:
  VoxelIndex() = default;
  explicit VoxelIndex(VoxelBits chosen);

  std::size_t size() const { return size_; }
  const VoxelBits& chosen() const { return chosen_; }
  bool has(IVec3 voxel) const { return chosen_.at(voxel); }
  /// @pre has(voxel)
  std::size_t of(IVec3 voxel) const;
  /// Number of the first chosen voxel at or after each word of a row. @param x, y from the box's
  /// lowest corner.
  const std::uint32_t* row(int x, int y) const;

 private:
  VoxelBits chosen_;
  std::vector<std::uint32_t> before_;  // each word of the box, how many are chosen
  std::size_t size_ = 0;
};

}  // namespace skerry::world
