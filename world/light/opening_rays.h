#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <vector>

#include "world/light/air_volume.h"
#include "world/light/base/seen_sky.h"
#include "world/light/opening_ray_ways.h"
#include "world/light/voxel_index.h"

namespace skerry::world {

/// What faces see of the sky where little of it is open to them: through windows, doors, the mouths
/// of caves. Of the 64 lattice vectors of a face few meet a window, the same from all faces, and
/// walls about it would have patches that all see it beside patches that none do. Where few lines
/// see the sky, 64 rays from the face's middle are asked in their place. There are eight sets of
/// them, by whether the voxel's coordinates are even or odd, so that the four voxels at a record's
/// corner have 256 together (decision 0087).
class OpeningRays {
 public:
  static constexpr std::size_t kRays = OpeningRaySet::kRays;
  /// Of a face's lines, the most that see the sky where rays are asked.
  static constexpr int kFewLines = 8;
  /// Voxels, along each axis, within which a line must see the sky from beside an opaque voxel if
  /// none of the face's own does: elsewhere it is dark.
  static constexpr int kNear = 2;

  /// All must outlive this.
  OpeningRays(const AirVolume& air, OpeningRayWays& ways, const VoxelIndex& wanted,
              const SeenSky& seen);

  /// Takes down which voxels see the sky, after all lines have been looked along.
  void take_lit();
  /// Whether rays are asked for a face, which looks to the voxel that lies before it.
  bool asks(IVec3 front, int face) const;
  /// A bit a ray: which see the sky. What is found is kept. @pre asks(front, face)
  std::uint64_t seen(IVec3 front, int face);
  /// Whether one of them passes stained glass. @pre seen(front, face) was asked
  bool passes_glass(IVec3 front, int face) const;

  /// Shares of a face's lobes that are seen, of 65280. @param rays of seen(front, face)
  static std::array<std::uint32_t, shared::kSkyLobes> lobes(IVec3 front, int face,
                                                            std::uint64_t rays);
  static std::size_t lobe_of_ray(IVec3 front, int face, std::size_t ray);

  // --- Edits ---

  /// What lies in a voxel has changed, or its view is no longer kept.
  void forget(IVec3 front);
  /// Tells the ways where rays begin, once they are to know.
  void add_origins() const;
  struct Face {
    IVec3 front{};
    int face = 0;
  };
  /// A ray may end elsewhere or pass other glass, if it was asked.
  void changed(IVec3 front, int face, std::size_t ray);
  /// All rays that begin in a voxel may.
  void changed_from(IVec3 front);
  /// Follows those again. @return the faces that see other parts of the sky, or through other
  /// glass.
  std::vector<Face> follow_changed();
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
  static std::uint64_t key_of(IVec3 front, int face);
  bool is_lit_now(IVec3 voxel) const;
  bool sees_sky_at(std::size_t number) const;
  bool is_near_lit(IVec3 voxel) const;
  /// Follows these again.
  void look(Known& face, std::uint64_t rays) const;

  const AirVolume& air_;
  OpeningRayWays& ways_;
  const VoxelIndex& wanted_;
  const SeenSky& seen_;
  VoxelBits lit_;
  std::vector<Known> known_;
  std::unordered_map<std::uint64_t, std::uint32_t> places_;  // in known_, by key_of()
  std::map<std::uint32_t, std::uint64_t> changed_;           // rays, by place in known_
};

}  // namespace skerry::world
