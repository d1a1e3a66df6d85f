#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "world/light/air_volume.h"
#include "world/light/base/sky_rays.h"

namespace skerry::world {

/// Straight lines through an island's voxels, from the middle of a face of one along a lattice
/// vector, over and over again, until they come to what is not open (line_voxels). Outside of the
/// volume all is air.
class LatticeLines {
 public:
  /// A voxel that a line passes on its way along a vector. @see line_voxels
  struct Passed {
    IVec3 offset{};
    std::ptrdiff_t step = 0;  ///< between the numbers of their bits
    int eighths = 0;          ///< of the vector that lie in the voxel; 0: an edge of it
    int entered = 0;          ///< direction of the face that the line comes in by
  };
  struct Way {
    IVec3 vector{};
    std::vector<Passed> passed;  ///< in the order of the line, the vector's end included
    int own_eighths = 0;         ///< of the vector that lie in the voxel that it begins in
  };
  static constexpr std::size_t kWays = kFans * shared::kSkyPatternCount;
  static constexpr std::size_t way_number(std::size_t fan, std::size_t pattern) {
    return fan * shared::kSkyPatternCount + pattern;
  }

  /// @param air must outlive this.
  explicit LatticeLines(const AirVolume& air);
  /// To be called for each voxel that has changed in the volume.
  void changed(IVec3 voxel);

  const Way& way(std::size_t number) const { return ways_[number]; }
  bool inside(IVec3 voxel) const;
  /// Opaque voxels, leaves and plants.
  const VoxelBits& solid() const { return solid_; }
  bool is_opaque(IVec3 voxel) const { return air_.opaque.at(voxel); }
  /// Whether a line passes a voxel. Leaves stop half of the ways, plants a quarter.
  bool open(IVec3 voxel, std::size_t way) const;
  /// Whether a line comes to what is not open on its way once along the vector.
  bool stopped(IVec3 from, std::size_t way) const;
  /// How many voxels it passes before that. @pre stopped(from, way)
  std::size_t passed_before_stop(IVec3 from, std::size_t way) const;
  /// The last voxel of a line from which it gets no further; none: it ends at the sky.
  std::optional<IVec3> end_of(IVec3 from, std::size_t way) const;

 private:
  Way way_along(IVec3 vector, int face_axis) const;
  const AirVolume& air_;
  VoxelBits solid_;
  std::vector<Way> ways_;
};

}  // namespace skerry::world
