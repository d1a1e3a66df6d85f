#pragma once
#include <vector>

#include "shaders/shared/geometry.h"

namespace skerry::game {

/// The look of every built-in block, indexed by block id, as the renderer takes it.
std::vector<shared::Material> material_table();

}  // namespace skerry::game
