#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "world/light/air_volume.h"
#include "world/light/base/sky_rays.h"

namespace skerry::world {

/// Straight lines through an island's voxels, from the middle of one along a lattice vector, over
/// and over again, until they touch what is not open. Outside of the volume all is air.
class LatticeLines {
 public:
  /// A voxel that a line touches on its way along a vector, the vector's end included.
  struct Touched {
    IVec3 offset{};
    std::ptrdiff_t step = 0;  ///< between the numbers of their bits
    int group = 0;            ///< those of a group are touched at once
    int eighths = 0;          ///< of the vector that lie in the voxel; 0: an edge or a corner of it
    /// Faces that the line can come in by, from what it has touched before; -1: no more.
    std::array<std::int8_t, 3> entered{-1, -1, -1};
  };
  struct Way {
    IVec3 vector{};
    std::vector<Touched> touched;  ///< in the order of the line
    int own_eighths = 0;           ///< of the vector that lie in the voxel that it begins in
  };
  static constexpr std::size_t kWays = kOctants * shared::kSkyPatternCount;
  static constexpr std::size_t way_number(int octant, std::size_t pattern) {
    return static_cast<std::size_t>(octant) * shared::kSkyPatternCount + pattern;
  }

  /// @param air must outlive this.
  explicit LatticeLines(const AirVolume& air);
  /// To be called for each voxel that has changed in the volume.
  void changed(IVec3 voxel);

  const Way& way(std::size_t number) const { return ways_[number]; }
  bool inside(IVec3 voxel) const;
  bool is_opaque(IVec3 voxel) const { return air_.opaque.at(voxel); }
  /// Whether a line passes a voxel. Leaves stop half of the ways, plants a quarter.
  bool open(IVec3 voxel, std::size_t way) const;
  /// Whether a line touches what is not open on its way once along the vector.
  bool stopped(IVec3 from, std::size_t way) const;
  /// Group of the voxels that stop it there. @pre stopped(from, way)
  int stopping_group(IVec3 from, std::size_t way) const;
  /// The last voxel of a line from which it gets no further; none: it ends at the sky.
  std::optional<IVec3> end_of(IVec3 from, std::size_t way) const;

 private:
  Way way_along(IVec3 vector) const;
  const AirVolume& air_;
  VoxelBits solid_;  // opaque voxels, leaves and plants
  std::vector<Way> ways_;
};

}  // namespace skerry::world
