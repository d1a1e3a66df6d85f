#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "shaders/shared/indirect.h"
#include "world/voxel/coords.h"

namespace skerry::world {

/// Ways to the sky: 8 octants of shared::kSkyPatterns. Bit 0 of an octant: x negative, 1 y, 2 z.
inline constexpr int kOctants = 8;

/// The lattice vector of a pattern in an octant.
IVec3 sky_direction(int octant, int pattern);

/// Voxels between a voxel and the one a lattice vector further that the line between their centres
/// touches, at an edge or a corner too, so that no line slips between two that meet at an edge.
/// Both ends are left out. @pre each component divides 4.
std::vector<IVec3> voxels_between(IVec3 direction);

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
