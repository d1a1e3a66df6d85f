#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shaders/shared/geometry.h"
#include "world/voxel/blocks.h"

namespace skerry::world {

/// Faces of one direction in one plane of a section, merged one by one. mesh_chunk merges by bits
/// and is many times as fast; here, what a face shows need not be what its voxel is made of.
class FaceSlice {
 public:
  static constexpr int kEdge = 64;  ///< voxels

  /// @param u, v place along the face's axes, 0 .. kEdge - 1. @param id not air.
  void set(int u, int v, BlockId id) { ids_[index(u, v)] = id; }
  /// Merges faces of one id into rectangles, runs along u first, and clears the slice.
  /// @param face direction. @param plane place of the voxels along it. @param u_end, v_end past
  ///   the last faces. @param out gets a quad for each rectangle, by v, then u of its corner.
  void merge(std::uint32_t face, int plane, int u_end, int v_end, std::vector<shared::Quad>& out);

 private:
  static std::size_t index(int u, int v) { return static_cast<std::size_t>(u + kEdge * v); }
  bool is_run(int u, int v, int count, BlockId id) const;
  std::array<BlockId, std::size_t{kEdge} * kEdge> ids_{};
};

}  // namespace skerry::world
