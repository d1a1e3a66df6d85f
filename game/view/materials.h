#pragma once
#include <span>
#include <vector>

#include "shaders/shared/geometry.h"
#include "world/light/bounce_light.h"

namespace skerry::game {

/// The look of every built-in block, indexed by block id, as the renderer takes it.
std::vector<shared::Material> material_table();

/// Mean colour of what the textures of every built-in block cover, indexed by block id. Lasts as
/// long as the program.
std::span<const world::FaceAlbedo> albedo_table();

}  // namespace skerry::game
