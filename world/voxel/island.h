#pragma once
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <string_view>
#include <vector>

#include "world/voxel/coords.h"

namespace skerry::world {

/// A rigid transform at one moment.
struct Pose {
  WorldPos origin;                          ///< where the lattice origin is
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< world from lattice
};

/// Everything that decides an island's voxels and its undisturbed motion. Plain values; two equal
/// specs generate equal voxels.
struct IslandSpec {
  std::uint64_t id = 0;          ///< unique in its world
  std::uint64_t seed = 0;        ///< feeds all noise of this island
  WorldPos origin;               ///< mean place of the lattice origin
  IVec3 box_min, box_max;        ///< lattice box that contains every voxel, [min, max) in blocks
  double bounding_radius = 0.0;  ///< blocks, about the lattice origin; contains the box's voxels
  std::uint32_t archetype = 0;   ///< silhouette family, meaning is the generator's
  std::uint32_t biome = 0;       ///< dominant biome, meaning is the generator's
  double yaw_rad = 0.0;          ///< heading at time 0
  double spin_rad_per_s = 0.0;   ///< about +y
  glm::dvec3 drift_amplitude{};  ///< blocks; drift is a slow closed path around `origin`
  double drift_period_s = 1.0;
  double drift_phase_rad = 0.0;
};

/// Widens a spec's box to contain a voxel; the radius stays. @return whether it had to.
bool include(IslandSpec& spec, IVec3 voxel);
/// The least bounding radius that contains a spec's box.
double radius_of(const IslandSpec& spec);

/// Pose of an undisturbed island. Closed form, so that any time can be asked for, in any order.
/// @param time_s seconds of play, any finite value; the angle is reduced before it grows large.
Pose pose_at(const IslandSpec& spec, double time_s);

/// Where a new player stands.
struct Spawn {
  WorldPos feet;  ///< on solid ground
  double yaw_deg = 0.0, pitch_deg = 0.0;
  std::uint64_t island = 0;  ///< id of the island stood on
};

/// A seed from what a player typed: decimal numbers 0 .. 2^64-1 are taken as they are, any other
/// text is hashed.
std::uint64_t seed_from_text(std::string_view text);

/// The archipelago's plan: every island whose bounding sphere comes within `radius_blocks` of
/// `centre`, nearest first, ties by id. Pure: same arguments, same answer, on any machine. The
/// origins do not include a world offset.
std::vector<IslandSpec> islands_within(std::uint64_t seed, WorldPos centre, double radius_blocks);

/// The seed's spawn. Generates the columns it needs. At time 0.
Spawn spawn_of(std::uint64_t seed);

}  // namespace skerry::world
