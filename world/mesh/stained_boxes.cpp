#include "world/mesh/stained_boxes.h"

#include <algorithm>
#include <cstddef>

namespace skerry::world {
namespace {

constexpr int kEdge = 64;

/// Voxels of a chunk that are in no box yet.
class Uncovered {
 public:
  explicit Uncovered(std::span<const StainedVoxel> voxels)
      : voxels_(voxels), covered_(voxels.size(), false) {}

  bool covered(std::size_t index) const { return covered_[index]; }
  /// Whether a box of voxels, within the chunk, is all of one block.
  bool all(const glm::ivec3& low, const glm::ivec3& size, BlockId block) const {
    return each(low, size, [&](std::size_t index) {
      return index < voxels_.size() && voxels_[index].block == block && !covered_[index];
    });
  }
  void cover(const glm::ivec3& low, const glm::ivec3& size) {
    each(low, size, [&](std::size_t index) { return covered_[index] = true; });
  }

 private:
  /// Calls fn(index; beyond all: no glass) until it says no.
  template <class Fn>
  bool each(const glm::ivec3& low, const glm::ivec3& size, const Fn& fn) const {
    for (int y = low.y; y < low.y + size.y; ++y)
      for (int x = low.x; x < low.x + size.x; ++x)
        for (int z = low.z; z < low.z + size.z; ++z)
          if (!fn(index_of(static_cast<std::uint32_t>(y << 12 | x << 6 | z)))) return false;
    return true;
  }
  std::size_t index_of(std::uint32_t place) const {
    const auto found = std::ranges::lower_bound(voxels_, place, {}, &StainedVoxel::place);
    if (found == voxels_.end() || found->place != place) return voxels_.size();
    return static_cast<std::size_t>(found - voxels_.begin());
  }

  std::span<const StainedVoxel> voxels_;
  std::vector<bool> covered_;
};

}  // namespace

std::vector<StainedBox> stained_boxes_of(std::span<const StainedVoxel> voxels) {
  std::vector<StainedBox> boxes;
  Uncovered uncovered(voxels);
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    if (uncovered.covered(i)) continue;
    const auto place = static_cast<int>(voxels[i].place);
    StainedBox box{{place >> 6 & 63, place >> 12 & 63, place & 63}, {1, 1, 1}, voxels[i].block};
    for (const int axis : {2, 0, 1}) {
      glm::ivec3 next = box.low, slice = box.size;
      slice[axis] = 1;
      for (next[axis] += 1; next[axis] < kEdge && uncovered.all(next, slice, box.block);
           ++next[axis])
        ++box.size[axis];
    }
    uncovered.cover(box.low, box.size);
    boxes.push_back(box);
  }
  return boxes;
}

}  // namespace skerry::world
