// What a scene file puts into its world: lights and blocks.
#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "engine/core/result.h"
#include "shaders/shared/light.h"
#include "world/voxel/blocks.h"
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

/// A box of one block that a scene puts into its world. Corners are whole blocks of the world, both
/// inside; `from` is the lower one on each axis.
struct BlockBox {
  world::BlockId block = world::kAir;
  std::array<std::int64_t, 3> from{}, to{};
};

/// Reads the field `blocks` of a scene file: docs/testing.md. Errors, naming the box: an unknown
/// field or block, a place that is not three whole numbers, more blocks than 2^20 in all.
Result<std::vector<BlockBox>> read_blocks(const nlohmann::json& value);

}  // namespace skerry::game
