#include "game/view/materials.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/gtc/packing.hpp>

#include "engine/core/check.h"
#include "engine/render/scene/block_textures.h"
#include "world/voxel/blocks.h"

namespace skerry::game {

std::vector<shared::Material> material_table() {
  std::vector<shared::Material> table;
  std::uint32_t classes = 0;
  for (const world::BlockType& type : world::block_types()) {
    shared::Material m{};
    m.layer_side = static_cast<std::uint32_t>(type.side);
    m.layer_top = static_cast<std::uint32_t>(type.top);
    m.layer_bottom = static_cast<std::uint32_t>(type.bottom);
    m.emission = glm::packHalf1x16(type.emission) |
                 static_cast<std::uint32_t>(glm::packHalf1x16(type.glows_from)) << 16;
    m.absorption = {type.absorption[0], type.absorption[1], type.absorption[2]};
    m.roughness = type.roughness;
    m.metalness = type.metalness;
    m.scattering = type.scattering;
    m.liquid = type.liquid ? 1u : 0u;
    const auto alike = std::find_if(table.begin(), table.end(), [&](const shared::Material& other) {
      return other.emission == m.emission && other.metalness == m.metalness &&
             std::abs(other.roughness - m.roughness) < 0.1f;
    });
    m.light_class = alike != table.end() ? alike->light_class : classes++;
    m.translucent_block = world::translucent_block(static_cast<unsigned>(table.size()));
    table.push_back(m);
  }
  SKERRY_ASSERT(table.size() <= shared::kMaxMaterials);
  return table;
}

namespace {

/// @param texels of one layer, RGBA8.
glm::vec3 mean_albedo(std::span<const std::byte> texels) {
  constexpr int kCovered = 128;  // of 255: the coverage of which a texel is drawn
  glm::dvec3 sum(0.0);
  double count = 0.0;
  for (std::size_t i = 0; i < texels.size(); i += 4) {
    if (std::to_integer<int>(texels[i + 3]) < kCovered) continue;
    for (int c = 0; c < 3; ++c)
      sum[c] += render::linear_from_srgb(texels[i + static_cast<std::size_t>(c)]);
    count += 1.0;
  }
  return count > 0.0 ? glm::vec3(sum / count) : glm::vec3(0.0f);
}

std::vector<world::FaceAlbedo> make_albedo_table() {
  const render::BlockTextures file = render::block_textures();
  const std::size_t layer_bytes = std::size_t{4} * file.edge * file.edge;
  std::vector<world::FaceAlbedo> table;
  for (const world::BlockType& type : world::block_types()) {
    const auto mean = [&](world::Texture texture) {
      return mean_albedo(
          file.texels.subspan(static_cast<std::size_t>(texture) * layer_bytes, layer_bytes));
    };
    const glm::vec3 side = mean(type.side);
    table.push_back({side, side, mean(type.top), mean(type.bottom), side, side});
  }
  return table;
}

}  // namespace

std::span<const world::FaceAlbedo> albedo_table() {
  static const std::vector<world::FaceAlbedo> kTable = make_albedo_table();
  return kTable;
}

}  // namespace skerry::game
