#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "world/light/air_volume.h"
#include "world/light/base/opening_ray_sets.h"
#include "world/light/base/seen_sky.h"
#include "world/light/lattice_lines.h"
#include "world/light/voxel_index.h"

namespace skerry::world {

/// What faces see of the sky where little of it is open to them: through windows, doors, the mouths
/// of caves. Of the 64 lattice vectors of a face few meet a window, the same from all faces, and
/// walls about it would have patches that all see it beside patches that none do. Where few lines
/// see the sky, 64 rays from the face's middle are asked in their place. There are eight sets of
/// them, by whether the voxel's coordinates are even or odd, so that the four voxels at a record's
/// corner have 256 together.
///
/// A ray passes from voxel to voxel by their faces, so that what is sealed off by blocks that meet
/// at edges or corners stays dark, and is stopped where a line would be (decision 0087).
class OpeningRays {
 public:
  static constexpr std::size_t kRays = OpeningRaySet::kRays;
  /// Of a face's lines, the most that see the sky where rays are asked.
  static constexpr int kFewLines = 8;
  /// Voxels, along each axis, within which a line must see the sky from beside an opaque voxel if
  /// none of the face's own does: elsewhere it is dark.
  static constexpr int kNear = 2;

  /// All must outlive this.
  OpeningRays(const AirVolume& air, const LatticeLines& lines, const VoxelIndex& wanted,
              const SeenSky& seen);

  /// Takes down which voxels see the sky, after all lines have been looked along.
  void take_lit();
  /// Whether rays are asked for a face, which looks to the voxel that lies before it.
  bool asks(IVec3 front, int face) const;
  /// A bit a ray: which see the sky. What is found is kept. @pre asks(front, face)
  std::uint64_t seen(IVec3 front, int face);
  /// Whether one of them passes stained glass. @pre seen(front, face) was asked
  bool passes_glass(IVec3 front, int face) const;
  /// What glass leaves of the light that comes along a ray to the sky, 0..1. @pre ray is seen
  glm::vec3 left_by_glass_on(IVec3 front, int face, std::size_t ray) const;

  /// Shares of a face's lobes that are seen, of 65280. @param rays of seen(front, face)
  static std::array<std::uint32_t, shared::kSkyLobes> lobes(IVec3 front, int face,
                                                            std::uint64_t rays);
  static std::size_t lobe_of_ray(IVec3 front, int face, std::size_t ray);

  // --- Edits ---

  /// What lies in a voxel has changed, or its view is no longer kept.
  void forget(IVec3 front);
  struct Face {
    IVec3 front{};
    int face = 0;
  };
  /// After voxels have changed: brings what is kept up to date. @return the faces that see other
  /// parts of the sky, or through other glass.
  std::vector<Face> changed(std::span<const IVec3> voxels);
  /// After lines of a voxel have changed, its view is no longer kept, or what lies beside it has
  /// changed. @return whether it counts as one that sees the sky otherwise than before.
  bool retake_lit(IVec3 voxel);

  std::size_t bytes() const;

 private:
  struct Known {
    IVec3 front{};
    int face = 0;
    std::uint64_t rays = 0, glass = 0;  // those that see the sky, and that pass glass on the way
  };
  static constexpr int kCell = 4;
  static constexpr std::uint64_t kHasFront = 1, kRock = 2;
  /// Number of a cell's first bit. @param x, y, z from the box's lowest corner.
  std::size_t cell_at(int x, int y, int z) const;
  std::uint64_t bits_of_cell(std::size_t cell) const { return cells_[cell / 64] >> cell % 64 & 3; }
  static std::uint64_t key_of(IVec3 front, int face);
  bool is_lit_now(IVec3 voxel) const;
  bool sees_sky_at(std::size_t number) const;
  bool is_near_lit(IVec3 voxel) const;
  /// Calls fn(block, voxels of the ray in it) for stained glass on the way.
  /// @return whether the ray comes to the sky.
  template <class Fn>
  bool follow(IVec3 front, int face, std::size_t ray, const Fn& fn) const;
  /// The same where there is no glass, by the planes' order that each ray has from all places.
  bool comes_to_sky(IVec3 front, int face, std::size_t ray) const;
  /// Follows these again.
  void look(Known& face, std::uint64_t rays) const;
  void mark_rock();
  void clear_rock_about(IVec3 voxel);
  void add_front(IVec3 voxel);
  template <class Fn>
  void for_each_through(IVec3 voxel, int face, const Fn& fn) const;

  const AirVolume& air_;
  const LatticeLines& lines_;
  const VoxelIndex& wanted_;
  const SeenSky& seen_;
  VoxelBits lit_;
  VoxelBits fronts_;              // from which rays of known_ begin
  IVec3 low_front_, high_front_;  // a box about them
  // Two bits for each kCell^3 voxels: whether one of them is in fronts_, and whether all of them
  // and all next to the cell are opaque. These are so few that processors keep them close by.
  std::vector<std::uint64_t> cells_;
  std::vector<Known> known_;
  std::unordered_map<std::uint64_t, std::uint32_t> places_;  // in known_, by key_of()
};

}  // namespace skerry::world
