#pragma once
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "engine/core/result.h"
#include "shaders/shared/light.h"
#include "world/voxel/coords.h"

namespace skerry::game {

/// A light at a place of the world.
struct WorldLight {
  world::WorldPos position;  ///< not used by a directional light
  shared::Light light{};     ///< as render::checked_light returns it; its position is not used
};

/// Reads the field `lights` of a scene file: docs/lights.md. Errors, naming the light: an unknown
/// field, one that is missing or that its kind does not have, a value out of its range.
Result<std::vector<WorldLight>> read_lights(const nlohmann::json& value);

}  // namespace skerry::game
