#include "game/scene_file/emission.h"

#include <array>
#include <cmath>
#include <numbers>

#include "engine/render/scene/block_textures.h"
#include "world/voxel/blocks.h"
#include "world/voxel/emission.h"

namespace skerry::game {
namespace {

double luminance(glm::dvec3 c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

/// A texture's light: mean radiance over the whole square, and the height of its middle, 0 below ..
/// 1.
struct Glow {
  glm::dvec3 mean{0.0};
  double height = 0.5;
};

Glow glow_of(const render::BlockTextures& file, const world::BlockType& type,
             world::Texture texture) {
  constexpr int kCovered = 128;  // of 255: the coverage of which a texel is drawn
  const std::size_t edge = file.edge;
  const std::byte* texels =
      file.texels.data() + 4 * edge * edge * static_cast<std::size_t>(texture);
  Glow glow;
  double raised = 0.0, light = 0.0;
  for (std::size_t row = 0; row < edge; ++row) {
    for (std::size_t column = 0; column < edge; ++column, texels += 4) {
      if (std::to_integer<int>(texels[3]) < kCovered) continue;
      const glm::dvec3 albedo{render::linear_from_srgb(texels[0]),
                              render::linear_from_srgb(texels[1]),
                              render::linear_from_srgb(texels[2])};
      const glm::dvec3 radiance = world::emitted_radiance(type, albedo);
      glow.mean += radiance;
      light += luminance(radiance);
      raised += luminance(radiance) * (1.0 - (static_cast<double>(row) + 0.5) / file.edge);
    }
  }
  glow.mean /= static_cast<double>(edge * edge);
  if (light > 0.0) glow.height = raised / light;
  return glow;
}

BlockEmission emission_of(const render::BlockTextures& file, const world::BlockType& type) {
  BlockEmission out;
  constexpr double kFluxOverSphere = 0.25;  // pi L A over 4 pi
  if (type.kind == world::BlockKind::kPlant) {
    constexpr double kArea = 4.0 * std::numbers::sqrt2;  // two diagonals, both sides
    const Glow glow = glow_of(file, type, type.side);
    out.face_intensity = glow.mean * (kArea * kFluxOverSphere);
    out.offset.y = static_cast<float>(glow.height - 0.5);
    return out;
  }
  const std::array<world::Texture, 6> sides{type.side,   type.side, type.top,
                                            type.bottom, type.side, type.side};
  glm::dvec3 mean(0.0);
  for (const world::Texture side : sides) mean += glow_of(file, type, side).mean / 6.0;
  out.face_intensity = mean * kFluxOverSphere;
  return out;
}

}  // namespace

std::vector<BlockEmission> emission_table() {
  const render::BlockTextures file = render::block_textures();
  std::vector<BlockEmission> table;
  for (const world::BlockType& type : world::block_types())
    table.push_back(type.emission > 0.0f ? emission_of(file, type) : BlockEmission{});
  return table;
}

}  // namespace skerry::game
