#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "shaders/shared/light.h"
#include "world/light/air_volume.h"

namespace skerry::world {

/// A face that has come or gone, from the lattice's origin.
struct ReachFace {
  IVec3 voxel{}, front{};  ///< of a plant the same
  int direction = 0;
  bool one_sided = false;  ///< of an opaque block: light that comes from behind is none of its
};

/// Bounds what the lamps of an island light of it, so that no shadow ray is traced where
/// nothing can arrive.
///
/// A straight line runs along each axis one way only. So it reaches a voxel from one of the at most
/// three neighbours that lie towards the lamp, and what no chain of such steps through air reaches
/// is dark. A face that looks away from a lamp is dark, too. The bound errs on the side of light
/// alone: such a chain need not be straight.
class LampReach {
 public:
  explicit LampReach(const LightChunks& chunks);
  /// For lamps whose range is in a box of voxels, or beyond all chunks. @param low, high included.
  LampReach(const LightChunks& chunks, IVec3 low, IVec3 high);

  /// Bricks of voxels, in the lattice of the chunks' level.
  struct Bricks {
    IVec3 low{}, size{};                                    ///< bricks; size 0: none
    int edge_log2 = 0;                                      ///< of a brick [voxels]
    std::array<std::uint32_t, shared::kReachWords> bits{};  ///< z + size.z * (x + size.x * y)
    bool operator==(const Bricks&) const = default;
    bool empty() const { return size.x == 0; }
    bool at(IVec3 voxel) const;
    /// Whether one of them is in a box of voxels. @param from, to both included.
    bool any_within(IVec3 from, IVec3 to) const;

   private:
    bool bit(int number) const {
      return bits[static_cast<std::size_t>(number / 32)] >> number % 32 & 1u;
    }
  };
  struct Found {
    /// Bricks of which the light may arrive at a drawn face or at a plant. Faces count for the
    /// voxels on both of their sides.
    Bricks lit;
    /// Those with a voxel that the light may enter. What lies elsewhere has no part in any of this.
    Bricks entered;
    bool operator==(const Found&) const = default;
  };
  /// The lamp's own voxel hides nothing, leaves let light past. @pre a face is drawn of the lamp's
  /// voxel, or a plant.
  Found of(IVec3 chunk, const StrongLamp& lamp) const;

  /// Whether what of() finds can be other because of faces that have come or gone: the light may
  /// enter where one of them is seen. A block comes or goes together with such faces.
  /// @param opaque as it is now; it holds a box about the lamp and the faces.
  static bool changes(const VoxelBits& opaque, IVec3 chunk, const StrongLamp& lamp,
                      std::span<const ReachFace> faces);

 private:
  void take_faces(const LightChunks& chunks);
  VoxelBits opaque_;
  std::array<VoxelBits, 6> fronts_;  // voxels in front of faces, by direction
  VoxelBits plants_;
  VoxelBits all_round_;  // both sides of faces that light passes
  VoxelBits any_;        // all of those
};

}  // namespace skerry::world
