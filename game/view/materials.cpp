#include "game/view/materials.h"

#include <glm/gtc/packing.hpp>

#include "engine/core/check.h"
#include "world/voxel/blocks.h"

namespace skerry::game {

std::vector<shared::Material> material_table() {
  std::vector<shared::Material> table;
  for (const world::BlockType& type : world::block_types()) {
    shared::Material m{};
    m.layer_side = static_cast<std::uint32_t>(type.side);
    m.layer_top = static_cast<std::uint32_t>(type.top);
    m.layer_bottom = static_cast<std::uint32_t>(type.bottom);
    m.emission = glm::packHalf1x16(type.emission);
    m.absorption = {type.absorption[0], type.absorption[1], type.absorption[2]};
    m.roughness = type.roughness;
    m.metalness = type.metalness;
    table.push_back(m);
  }
  SKERRY_ASSERT(table.size() <= shared::kMaxMaterials);
  return table;
}

}  // namespace skerry::game
