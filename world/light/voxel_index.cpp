#include "world/light/voxel_index.h"

#include <bit>
#include <utility>

namespace skerry::world {

VoxelIndex::VoxelIndex(VoxelBits chosen) : chosen_(std::move(chosen)) {
  const IVec3 size = chosen_.size();
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      for (int w = 0; w < chosen_.row_words(); ++w) {
        before_.push_back(static_cast<std::uint32_t>(size_));
        size_ += static_cast<std::size_t>(std::popcount(chosen_.row(x, y)[w]));
      }
}

std::size_t VoxelIndex::of(IVec3 voxel) const {
  const IVec3 low = chosen_.low();
  const IVec3 p{voxel.x - low.x, voxel.y - low.y, voxel.z - low.z};
  const std::uint64_t earlier =
      chosen_.row(p.x, p.y)[p.z / 64] & ((std::uint64_t{1} << p.z % 64) - 1);
  return row(p.x, p.y)[p.z / 64] + static_cast<std::size_t>(std::popcount(earlier));
}

const std::uint32_t* VoxelIndex::row(int x, int y) const {
  return before_.data() + static_cast<std::size_t>(y * chosen_.size().x + x) *
                              static_cast<std::size_t>(chosen_.row_words());
}

}  // namespace skerry::world
