#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shaders/shared/indirect.h"
#include "world/voxel/coords.h"

namespace skerry::world {

/// Ways to the sky: 8 octants of shared::kSkyPatterns. Bit 0 of an octant: x negative, 1 y, 2 z.
inline constexpr int kOctants = 8;

/// The lattice vector of a pattern in an octant.
IVec3 sky_direction(int octant, int pattern);

/// A voxel on a line.
struct LineVoxel {
  IVec3 offset{};   ///< from the voxel that the line begins in
  int axis = 0;     ///< of the plane that the line enters it through
  int entered = 0;  ///< after so many eighths of the vector
};
/// The voxels in order that a line passes on its way from the middle of a voxel's face along a
/// lattice vector, the vector's end included. The face is the one of that axis that the line enters
/// the voxel by.
///
/// Each voxel shares a face with the one before: no line slips between two that meet at an edge.
/// Where it crosses planes at once it crosses one of them first, as if it ran a little aside, so
/// that a block of which it touches an edge stops half of such lines: of axes a < b that of a if
/// the vector points the same way, up or down, along a and along the third axis, and the other way
/// round if the sum of its parts' lengths is even. @pre each component divides 4.
std::vector<LineVoxel> line_voxels(IVec3 direction, int face_axis);

/// Directions of an octant from the middles of faces of an axis.
inline constexpr std::size_t kFans = 3 * kOctants;
constexpr std::size_t fan_of(int axis, int octant) {
  return static_cast<std::size_t>(axis * kOctants + octant);
}
/// Of a face, those before it: by quarter, bit 0: negative along the first axis after its own (y
/// after x, z after y, x after z), bit 1: along the second.
std::array<std::size_t, 4> fans_of_face(int face);
constexpr int octant_of(std::size_t fan) {
  return static_cast<int>(fan) % kOctants;
}
constexpr int axis_of(std::size_t fan) {
  return static_cast<int>(fan) / kOctants;
}

/// Leaves stop half of the rays. Each pattern belongs to a leaf set, pattern % kLeafSets, and other
/// voxels of leaves stop the rays of another set.
inline constexpr int kLeafSets = 8;
/// Bit z % 64: whether leaves there stop the rays of a set. @param z_word z / 64, rounded down.
std::uint64_t leaves_that_stop(int leaf_set, int x, int y, int z_word);
/// Alike of plants, which stop a quarter.
std::uint64_t plants_that_stop(int leaf_set, int x, int y, int z_word);

/// What each of an octant's patterns weighs for a face of this axis: its cell's share of the
/// irradiance of the octant under an even sky, of 65280. The cell of a pattern holds the directions
/// of its octant that are nearest to it.
using LobeWeights = std::array<std::uint32_t, shared::kSkyPatternCount>;
const LobeWeights& lobe_weights(int axis);

/// The lobe of a face of this axis that a pattern's cell belongs to.
std::size_t lobe_of(int axis, int octant, std::size_t pattern);

/// Adds the shares of a face's lobes that are seen in an octant, of 65280. @param seen a bit a
/// pattern of it.
void add_lobes_seen(int axis, int octant, std::uint32_t seen,
                    std::array<std::uint32_t, shared::kSkyLobes>& sum);

}  // namespace skerry::world
