#include "world/light/voxel_index.h"

#include <bit>
#include <utility>

namespace skerry::world {

VoxelIndex::VoxelIndex(VoxelBits chosen) : chosen_(std::move(chosen)) {
  const IVec3 size = chosen_.size();
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      for (int w = 0; w < chosen_.row_words(); ++w) {
        first_.push_back(static_cast<std::uint32_t>(size_));
        size_ += static_cast<std::size_t>(std::popcount(chosen_.row(x, y)[w]));
      }
}

/// Numbers that nobody has.
std::uint32_t VoxelIndex::run_of(int length) {
  std::vector<std::uint32_t>& free = free_runs_[static_cast<std::size_t>(length)];
  if (free.empty()) {
    size_ += static_cast<std::size_t>(length);
    return static_cast<std::uint32_t>(size_) - static_cast<std::uint32_t>(length);
  }
  const std::uint32_t run = free.back();
  free.pop_back();
  return run;
}

std::vector<VoxelIndex::Moved> VoxelIndex::add(IVec3 voxel) {
  const Place place = place_of(voxel);
  const int count = std::popcount(place.bits),
            earlier = std::popcount(place.bits & ((std::uint64_t{1} << place.bit) - 1));
  const std::uint32_t old = first_[place.word], run = run_of(count + 1);
  std::vector<Moved> moved;
  for (int i = 0; i < count; ++i)
    moved.push_back({old + static_cast<std::size_t>(i),
                     run + static_cast<std::size_t>(i < earlier ? i : i + 1)});
  if (count != 0) free_runs_[static_cast<std::size_t>(count)].push_back(old);
  first_[place.word] = run;
  chosen_.set(voxel);
  return moved;
}

std::vector<VoxelIndex::Moved> VoxelIndex::remove(IVec3 voxel) {
  const Place place = place_of(voxel);
  const auto count = static_cast<std::size_t>(std::popcount(place.bits));
  const std::size_t first = first_[place.word];
  std::vector<Moved> moved;
  for (std::size_t at = of(voxel) + 1; at < first + count; ++at) moved.push_back({at, at - 1});
  // The last number of the run is a free one.
  free_runs_[1].push_back(static_cast<std::uint32_t>(first + count - 1));
  chosen_.set(voxel, false);
  return moved;
}

}  // namespace skerry::world
