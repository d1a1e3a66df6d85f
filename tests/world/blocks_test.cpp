#include "world/voxel/blocks.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <set>

namespace skerry::world {
namespace {

TEST(Blocks, EveryIdHasAUniqueLowerCaseName) {
  std::set<std::string_view> names;
  for (const BlockType& type : block_types()) {
    EXPECT_FALSE(type.name.empty());
    EXPECT_EQ(type.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string_view::npos)
        << type.name;
    EXPECT_TRUE(names.insert(type.name).second) << type.name;
  }
  EXPECT_EQ(names.size(), std::size_t{block::kBuiltInCount});
}

TEST(Blocks, RowsSitAtTheirIds) {
  const auto name = [](BlockId id) { return block_types()[id].name; };
  EXPECT_EQ(name(kAir), "air");
  EXPECT_EQ(name(block::kStone), "stone");
  EXPECT_EQ(name(block::kRedRockBanded), "red_rock_banded");
  EXPECT_EQ(name(block::kGlowstone), "glowstone");
  EXPECT_EQ(name(block::kOakLog), "oak_log");
  EXPECT_EQ(name(block::kBlossomLeaves), "blossom_leaves");
  EXPECT_EQ(name(block::kHeather), "heather");
  EXPECT_EQ(name(block::kMycelium), "mycelium");
  EXPECT_EQ(name(block::kWater), "water");
  EXPECT_EQ(name(block::kLamp), "lamp");
}

TEST(Blocks, TranslucentOnesAreNumberedFromOne) {
  unsigned count = 0;
  for (std::size_t id = 0; id < block_types().size(); ++id) {
    const auto block = static_cast<BlockId>(id);
    const unsigned number = translucent_number(block);
    EXPECT_EQ(number != 0, block_kind(block) == BlockKind::kTranslucent) << block;
    if (number != 0) {
      EXPECT_EQ(number, ++count);
      EXPECT_EQ(translucent_block(number), block);
    }
  }
  EXPECT_EQ(count, 18u);
  EXPECT_EQ(translucent_number(60000), 0u);
  EXPECT_EQ(translucent_block(0), kAir);
  EXPECT_EQ(translucent_block(count + 1), kAir);
  EXPECT_EQ(translucent_block(99), kAir);
}

TEST(Blocks, PropertiesStayInTheirRanges) {
  for (const BlockType& type : block_types()) {
    constexpr int kColours = 16;
    for (const Texture face : {type.side, type.top, type.bottom})
      EXPECT_LT(static_cast<int>(face), static_cast<int>(Texture::kStainedGlass) + kColours)
          << type.name;
    EXPECT_GE(type.roughness, 0.0f) << type.name;
    EXPECT_LE(type.roughness, 1.0f) << type.name;
    EXPECT_GE(type.metalness, 0.0f) << type.name;
    EXPECT_LE(type.metalness, 1.0f) << type.name;
    EXPECT_GE(type.emission, 0.0f) << type.name;
    EXPECT_GE(type.glows_from, 0.0f) << type.name;
    EXPECT_LE(type.glows_from, 1.0f) << type.name;
    EXPECT_TRUE(type.glows_from == 0.0f || type.emission > 0.0f) << type.name;
    const bool absorbs =
        type.absorption[0] > 0.0f || type.absorption[1] > 0.0f || type.absorption[2] > 0.0f;
    EXPECT_EQ(absorbs, type.kind == BlockKind::kTranslucent) << type.name;
    EXPECT_EQ(type.scattering > 0.0f, type.kind == BlockKind::kTranslucent) << type.name;
    EXPECT_TRUE(!type.liquid || type.kind == BlockKind::kTranslucent) << type.name;
  }
}

TEST(Blocks, GlowingThingsGlow) {
  for (BlockId id : {block::kLava, block::kGlowstone, block::kCrystalBlue, block::kCrystalViolet,
                     block::kGlowShroom, block::kGlowFern, block::kTorch, block::kLamp,
                     block::kMushroomCapGlow}) {
    EXPECT_GT(block_types()[id].emission, 0.0f) << block_types()[id].name;
  }
  EXPECT_EQ(block_types()[block::kStone].emission, 0.0f);
}

TEST(Blocks, WaterTakesRedFirst) {
  const auto& a = block_types()[block::kWater].absorption;
  EXPECT_GT(a[0], a[1]);
  EXPECT_GT(a[1], a[2]);
}

TEST(Blocks, StainedGlassTakesLeastOfItsOwnColour) {
  const auto least = [](BlockId id) {
    const auto& a = block_types()[id].absorption;
    return std::min_element(a.begin(), a.end()) - a.begin();
  };
  EXPECT_EQ(least(block::kRedGlass), 0);
  EXPECT_EQ(least(block::kGreenGlass), 1);
  EXPECT_EQ(least(block::kBlueGlass), 2);
  for (int id = block::kWhiteGlass; id <= block::kPinkGlass; ++id) {
    EXPECT_TRUE(is_glass(static_cast<BlockId>(id)));
    EXPECT_TRUE(block_types()[static_cast<std::size_t>(id)].name.ends_with("_glass"));
  }
  EXPECT_TRUE(is_glass(block::kGlass));
  EXPECT_FALSE(is_glass(block::kWater));
  EXPECT_FALSE(is_glass(block::kIce));
}

TEST(Blocks, UnknownIdsAreOpaqueAndSolid) {
  EXPECT_EQ(block_kind(block::kBuiltInCount), BlockKind::kOpaque);
  EXPECT_EQ(block_kind(65535), BlockKind::kOpaque);
  EXPECT_TRUE(is_solid(65535));
}

TEST(Blocks, PlayersStandOnOpaqueCutoutAndGlassOnly) {
  EXPECT_TRUE(is_solid(block::kStone));
  EXPECT_TRUE(is_solid(block::kOakLeaves));
  EXPECT_TRUE(is_solid(block::kGlass));
  EXPECT_TRUE(is_solid(block::kWhiteGlass));
  EXPECT_TRUE(is_solid(block::kPinkGlass));
  EXPECT_FALSE(is_solid(kAir));
  EXPECT_FALSE(is_solid(block::kWater));
  EXPECT_FALSE(is_solid(block::kTallGrass));
}

}  // namespace
}  // namespace skerry::world
