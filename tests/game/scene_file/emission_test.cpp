#include "game/scene_file/emission.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tools/reference/textures.h"
#include "world/voxel/blocks.h"

namespace skerry::game {
namespace {

/// Share of a block's emission that a texel has: dark ones of a torch or a crystal have less.
double share_of(const world::BlockType& type, const glm::dvec3& albedo) {
  const double missing = type.glows_from - std::max({albedo.x, albedo.y, albedo.z});
  return missing <= 0.0 ? 1.0 : std::max(0.0, 1.0 - 2.0 * missing);
}

/// A face's mean radiance, by the reference's own reading of the textures.
glm::dvec3 mean_radiance(world::BlockId block, int face) {
  const world::BlockType& type = world::block_types()[block];
  constexpr int kEdge = 256;  // at least as many samples as texels
  glm::dvec3 sum(0.0);
  for (int i = 0; i < kEdge; ++i) {
    for (int j = 0; j < kEdge; ++j) {
      const double a = (i + 0.5) / kEdge, b = (j + 0.5) / kEdge;
      const glm::dvec4 texel = reference::BlockTexels::shared().texel(
          block, face, face >= 6 ? glm::dvec3(a, b, a) : glm::dvec3(a, 0.0, b));
      if (texel.w >= 0.5) sum += glm::dvec3(texel) * share_of(type, texel);
    }
  }
  return sum * static_cast<double>(type.emission) / static_cast<double>(kEdge * kEdge);
}

TEST(Emission, ABlocksFaceSendsOutItsLambertianFlux) {
  const std::vector<BlockEmission> table = emission_table();
  ASSERT_EQ(table.size(), world::block_types().size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto id = static_cast<world::BlockId>(i);
    const world::BlockType& type = world::block_types()[id];
    if (type.emission == 0.0f) {
      EXPECT_EQ(table[id].face_intensity, glm::vec3(0.0f)) << type.name;
      continue;
    }
    const bool plant = type.kind == world::BlockKind::kPlant;
    const glm::dvec3 radiance = mean_radiance(id, plant ? 6 : 2);
    // Flux pi L A over the sphere's 4 pi; a plant's quads are sqrt 2 wide and have two sides each.
    const double area = plant ? 4.0 * std::numbers::sqrt2 : 1.0;
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(table[id].face_intensity[c], radiance[c] * area / 4.0, 1e-4 * radiance[c])
          << type.name;
    EXPECT_LT(std::abs(table[id].offset.y), 0.5f);
  }
  EXPECT_GT(table[world::block::kTorch].offset.y, 0.1f) << "a flame is at the top of its torch";
}

TEST(Emission, ALightReachesToWhereItIsTheLeastThatCounts) {
  for (const float intensity : {0.01f, 1.0f, 300.0f}) {
    const float range = light_range({0.2f * intensity, intensity, 0.0f});
    EXPECT_NEAR(intensity / (range * range), kLeastIrradiance, 1e-6f);
  }
}

}  // namespace
}  // namespace skerry::game
