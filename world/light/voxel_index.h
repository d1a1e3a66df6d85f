#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "world/light/air_volume.h"

namespace skerry::world {

/// Numbers some voxels of a box from 0 on, so that those of a row's word follow each other. Voxels
/// can come and go; numbers that nobody has any more are handed out again.
class VoxelIndex {
 public:
  /// A voxel's number that has become another.
  struct Moved {
    std::size_t from, to;
  };

  VoxelIndex() = default;
  explicit VoxelIndex(VoxelBits chosen);

  /// All numbers are below.
  std::size_t size() const { return size_; }
  const VoxelBits& chosen() const { return chosen_; }
  bool has(IVec3 voxel) const { return chosen_.at(voxel); }
  /// @pre has(voxel)
  std::size_t of(IVec3 voxel) const {
    const Place place = place_of(voxel);
    const std::uint64_t earlier = place.bits & ((std::uint64_t{1} << place.bit) - 1);
    return first_[place.word] + static_cast<std::size_t>(std::popcount(earlier));
  }
  /// Number of the first chosen voxel of each word of a row. @param x, y from the box's lowest
  /// corner.
  const std::uint32_t* row(int x, int y) const { return first_.data() + word_at(x, y, 0); }

  /// Takes a voxel in. @pre it is inside and not chosen. @return whose numbers change by that, to
  /// be moved in this order.
  std::vector<Moved> add(IVec3 voxel);
  /// Lets one go, alike. @pre has(voxel)
  std::vector<Moved> remove(IVec3 voxel);

 private:
  std::size_t word_at(int x, int y, int word) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(chosen_.size().x) +
            static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(chosen_.row_words()) +
           static_cast<std::size_t>(word);
  }
  struct Place {
    std::uint64_t bits;  // of the voxel's word
    std::size_t word;    // in first_
    int bit;
  };
  Place place_of(IVec3 voxel) const {
    const IVec3 low = chosen_.low();
    const IVec3 p{voxel.x - low.x, voxel.y - low.y, voxel.z - low.z};
    return {chosen_.row(p.x, p.y)[p.z / 64], word_at(p.x, p.y, p.z / 64), p.z % 64};
  }
  std::uint32_t run_of(int length);

  VoxelBits chosen_;
  std::vector<std::uint32_t> first_;
  std::size_t size_ = 0;
  std::array<std::vector<std::uint32_t>, 65> free_runs_;  // by length
};

}  // namespace skerry::world
