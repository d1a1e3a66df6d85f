#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "world/light/base/sky_rays.h"

namespace skerry::world {

/// Ways to the sky that voxels see, by their numbers: for each fan a bit a pattern. Those of a fan
/// lie together, so that threads that look along different fans write to memory of their own.
class SeenSky {
 public:
  SeenSky() = default;
  explicit SeenSky(std::size_t voxels) { resize(voxels); }
  bool empty() const { return fans_[0].empty(); }
  /// What voxels see that are new: nothing.
  void resize(std::size_t voxels) {
    for (std::vector<std::uint16_t>& fan : fans_) fan.resize(voxels, 0);
  }
  std::size_t bytes() const { return kFans * fans_[0].size() * sizeof(std::uint16_t); }

  /// How many of the 64 lines of a face before a voxel see it.
  int lines_of_face(std::size_t voxel, int face) const {
    int lines = 0;
    for (const std::size_t fan : fans_of_face(face)) lines += std::popcount(of(voxel, fan));
    return lines;
  }

  std::uint16_t of(std::size_t voxel, std::size_t fan) const { return fans_[fan][voxel]; }
  std::uint16_t& of(std::size_t voxel, std::size_t fan) { return fans_[fan][voxel]; }
  /// A voxel's number becomes another.
  void move(std::size_t from, std::size_t to) {
    for (std::vector<std::uint16_t>& fan : fans_) fan[to] = fan[from];
  }
  void forget(std::size_t voxel) {
    for (std::vector<std::uint16_t>& fan : fans_) fan[voxel] = 0;
  }

 private:
  std::array<std::vector<std::uint16_t>, kFans> fans_;
};

}  // namespace skerry::world
