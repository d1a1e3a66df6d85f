#pragma once
#include <algorithm>
#include <glm/vec3.hpp>

#include "shaders/shared/geometry.h"
#include "world/voxel/blocks.h"

namespace skerry::world {

/// Radiance that a texel of a block emits [the unit of sun radiance]. The shaders' emission_of()
/// agrees with it.
inline glm::dvec3 emitted_radiance(const BlockType& type, glm::dvec3 albedo) {
  const double brightest = std::max({albedo.x, albedo.y, albedo.z});
  const double above = (brightest - static_cast<double>(type.glows_from)) / shared::kGlowRise;
  return albedo * (static_cast<double>(type.emission) * std::clamp(1.0 + above, 0.0, 1.0));
}

}  // namespace skerry::world
