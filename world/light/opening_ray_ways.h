#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "world/light/air_volume.h"
#include "world/light/base/face_records.h"
#include "world/light/base/opening_ray_sets.h"
#include "world/light/lattice_lines.h"

namespace skerry::world {

/// Ways of OpeningRaySet's rays through an island's voxels, and back from a voxel to all faces
/// whose rays pass it.
///
/// A ray passes from voxel to voxel by their faces, so that what is sealed off by blocks that meet
/// at edges or corners stays dark, and is stopped where a line would be (decision 0087).
class OpeningRayWays {
 public:
  static constexpr std::size_t kRays = OpeningRaySet::kRays;

  /// Both must outlive this.
  OpeningRayWays(const AirVolume& air, const LatticeLines& lines);

  /// What stops a ray.
  struct End {
    IVec3 voxel{};
    int entered = 0;  ///< direction of the face that the ray comes in by
  };
  /// None: it comes to the sky. @param front the voxel before the face.
  std::optional<End> end_of(IVec3 front, int face, std::size_t ray) const;
  /// Whether it passes stained glass on its way to the end.
  bool passes_glass(IVec3 front, int face, std::size_t ray) const;
  /// What glass leaves of the light that comes along it, 0..1.
  glm::vec3 left_by_glass(IVec3 front, int face, std::size_t ray) const;

  // --- Back ---

  /// Whether begin_origins() was called. Without edits nobody asks for ways back.
  bool has_origins() const { return !cells_.empty(); }
  void begin_origins();
  /// Rays begin in a voxel. @pre has_origins()
  void add_origin(IVec3 voxel);
  /// They do not.
  void remove_origin(IVec3 voxel);
  /// A voxel is opaque no longer.
  void opened(IVec3 voxel);
  /// Calls fn(front, face, ray) for the faces before origins from which a ray passes a voxel, or
  /// would if nothing stopped it before, but not those behind rock. All rays of a set go alike from
  /// wherever they begin, so their ways are gone back here. A ray passes a voxel at most one away,
  /// along each axis, from where another of its direction does that passes the same voxel: where
  /// one is in the middle of rock, so are all that come from further back (decision 0092).
  template <class Fn>
  void for_each_through(IVec3 voxel, const Fn& fn) const {
    for (int face = 0; face < 6; ++face)
      for (std::size_t set = 0; set < OpeningRaySet::kSets; ++set)
        for (std::size_t ray = 0; ray < kRays; ++ray)
          go_back(voxel, face, set, ray, [&](IVec3 front) { fn(front, face, ray); });
  }
  std::size_t bytes() const;

 private:
  static constexpr int kCell = 4;
  static constexpr std::uint64_t kHasOrigin = 1, kRock = 2;
  template <class Fn>
  bool follow(IVec3 front, int face, std::size_t ray, const Fn& fn) const;
  /// Number of a cell's first bit. @param x, y, z from the box's lowest corner.
  std::size_t cell_at(int x, int y, int z) const {
    const auto cells = [](int voxels) { return (voxels + kCell - 1) / kCell; };
    const IVec3 size = origins_.size();
    return static_cast<std::size_t>(
        2 * ((y / kCell * cells(size.x) + x / kCell) * cells(size.z) + z / kCell));
  }
  std::uint64_t bits_of_cell(std::size_t cell) const { return cells_[cell / 64] >> cell % 64 & 3; }
  void mark_rock();
  template <class Fn>
  void go_back(IVec3 voxel, int face, std::size_t of_set, std::size_t ray, const Fn& fn) const;

  const AirVolume& air_;
  const LatticeLines& lines_;
  VoxelBits origins_;
  IVec3 low_origin_, high_origin_;  // a box about them
  // Two bits for each kCell^3 voxels: whether one of them is an origin, and whether all of them and
  // all next to the cell are opaque. These are so few that processors keep them close by.
  std::vector<std::uint64_t> cells_;
};

template <class Fn>
void OpeningRayWays::go_back(IVec3 voxel, int face, std::size_t of_set, std::size_t ray,
                             const Fn& fn) const {
  const OpeningRaySet& set = OpeningRaySet::of(of_set, face);
  const IVec3 low = origins_.low();
  const std::array<int, 3> at{voxel.x - low.x, voxel.y - low.y, voxel.z - low.z};
  const std::array<int, 3> below{voxel.x - low_origin_.x, voxel.y - low_origin_.y,
                                 voxel.z - low_origin_.z},
      above{high_origin_.x - voxel.x, high_origin_.y - voxel.y, high_origin_.z - voxel.z};
  std::array<int, 3> step{}, most{};
  for (std::size_t a = 0; a < 3; ++a) {
    const bool down = (set.down[ray] >> a & 1) != 0;
    step[a] = down ? -1 : 1;
    most[a] = down ? above[a] : below[a];
  }
  /// @return whether what lies further back may be of interest.
  const auto ask = [&](const std::array<int, 3>& steps, bool is_of_set) {
    if (steps[0] > most[0] || steps[1] > most[1] || steps[2] > most[2]) return false;
    const std::array<int, 3> its{at[0] - step[0] * steps[0], at[1] - step[1] * steps[1],
                                 at[2] - step[2] * steps[2]};
    const std::uint64_t cell = bits_of_cell(cell_at(its[0], its[1], its[2]));
    if ((cell & kRock) != 0) return false;
    if (!is_of_set || (cell & kHasOrigin) == 0) return true;
    const IVec3 front = low + IVec3{its[0], its[1], its[2]};
    if (origins_.bit(origins_.bit_at(front))) fn(front);
    return true;
  };
  const std::size_t odd = OpeningRaySet::parity_of(voxel) ^ of_set;
  for (const OpeningRaySet::Steps& steps : set.steps(ray, odd))
    if (!ask({steps[0], steps[1], steps[2]}, true)) return;
  const OpeningRaySet::Steps& counted = set.after_counted[ray];
  std::array<int, 3> steps{counted[0], counted[1], counted[2]};
  if (!ask(steps, false)) return;
  for_each_plane(set.rays[ray], OpeningRaySet::kCountedPlanes, [&](std::size_t axis) {
    ++steps[axis];
    return ask(steps, OpeningRaySet::parity_of({steps[0], steps[1], steps[2]}) == odd);
  });
}

}  // namespace skerry::world
