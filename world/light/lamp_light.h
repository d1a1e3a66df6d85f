#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <unordered_map>

#include "world/light/air_volume.h"

namespace skerry::world {

/// Irradiance of weak lamps in voxels, for each of the six face directions: the mean over the
/// voxel's side that lies behind it, where the face is that looks there.
using LampLight = std::array<glm::vec3, 6>;

/// What a lamp gives a voxel: nothing unless the line to its middle is clear. A line that passes
/// where voxels meet at an edge or a corner needs all of them clear; leaves take half, plants a
/// quarter; the lamp's own voxel hides nothing. @param lamp place from the lattice's origin.
/// @return zeros: none.
LampLight light_of_lamp(const AirVolume& air, const WeakLamp& lamp, IVec3 voxel);

inline bool is_dark(const LampLight& light) {
  return light == LampLight{};
}

}  // namespace skerry::world
