#pragma once
#include <cmath>
#include <cstddef>
#include <glm/vec3.hpp>

#include "world/light/air_volume.h"

namespace skerry::world {

/// What reaches faces of an island of the light of a body, sun or moon, past the island's voxels:
/// straight lines in that very direction, where lattice lines know only their own.
class BodyRays {
 public:
  /// @param air must outlive this. @param to_body in the lattice, unit.
  BodyRays(const AirVolume& air, const glm::vec3& to_body);

  /// Irradiance of a face over that of a surface that faces the body with nothing before it, by
  /// colour: the mean over nine places of the face. Leaves stop half of the lines, plants a
  /// quarter, stained glass takes what Beer's law says. @param front the voxel before the face; of
  /// a plant, its own, and the face looks up. @pre the volume holds it.
  glm::vec3 on_face(IVec3 front, int face) const;
  /// Calls fn(voxel) for those from which a line can pass a voxel that is in the volume: all that
  /// such a line begins in, and some beside them.
  template <class Fn>
  void for_each_behind(IVec3 voxel, const Fn& fn) const {
    // Layer by layer of the axis that the direction goes along most: within one, a line moves by up
    // to a voxel along the others, and the voxel is one wide.
    const float least = to_body_[most_];
    const int sign = least > 0.0f ? 1 : -1, u = (most_ + 1) % 3, v = (most_ + 2) % 3;
    for (int layer = 0;; ++layer) {
      glm::ivec3 at = vector_of(voxel);
      at[most_] -= sign * layer;
      const float back = static_cast<float>(layer) / std::abs(least);
      const int low_u = at[u] + static_cast<int>(std::floor(-to_body_[u] * back)) - 1,
                low_v = at[v] + static_cast<int>(std::floor(-to_body_[v] * back)) - 1;
      const int from = vector_of(air_.opaque.low())[most_];
      if (at[most_] < from || at[most_] >= from + vector_of(air_.opaque.size())[most_]) return;
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
          at[u] = low_u + i;
          at[v] = low_v + j;
          fn(IVec3{at.x, at.y, at.z});
        }
    }
  }

 private:
  glm::vec3 along(glm::vec3 from, IVec3 voxel, int ray) const;
  bool stops(std::ptrdiff_t bit, IVec3 voxel, int ray) const;
  const AirVolume& air_;
  glm::vec3 to_body_, step_;          // step_: of the line, from a plane of voxels to the next
  glm::vec<3, std::ptrdiff_t> bits_;  // between the numbers of voxels' bits
  int most_ = 0;                      // axis
};

}  // namespace skerry::world
