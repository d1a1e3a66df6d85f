#include "world/voxel/blocks.h"

#include <algorithm>

namespace skerry::world {
namespace {

using enum BlockKind;
using T = Texture;

constexpr BlockType opaque(std::string_view name, Texture all, float roughness = 0.9f,
                           float emission = 0.0f) {
  return {name, kOpaque, all, all, all, emission, roughness, {}};
}
constexpr BlockType sided(std::string_view name, Texture side, Texture top, Texture bottom,
                          float roughness = 0.9f) {
  return {name, kOpaque, side, top, bottom, 0.0f, roughness, {}};
}
constexpr BlockType log(std::string_view name, Texture side, Texture end) {
  return sided(name, side, end, end, 0.85f);
}
constexpr BlockType ore(std::string_view name, Texture all, float roughness, float metalness) {
  return {name, kOpaque, all, all, all, 0.0f, roughness, {}, metalness};
}
constexpr BlockType leaves(std::string_view name, Texture all) {
  return {name, kCutout, all, all, all, 0.0f, 0.8f, {}};
}
constexpr BlockType translucent(std::string_view name, Texture all, std::array<float, 3> absorption,
                                float scattering) {
  BlockType out{name, kTranslucent, all, all, all, 0.0f, 0.05f, absorption};
  out.scattering = scattering;
  return out;
}
constexpr BlockType liquid(std::string_view name, Texture all, std::array<float, 3> absorption,
                           float scattering) {
  BlockType out = translucent(name, all, absorption, scattering);
  out.liquid = true;
  return out;
}
/// @param colour of the layers of stained glass, 0..15.
constexpr BlockType stained(int colour, std::string_view name, std::array<float, 3> absorption) {
  return translucent(name, static_cast<Texture>(static_cast<int>(T::kStainedGlass) + colour),
                     absorption, 0.01f);
}
constexpr BlockType plant(std::string_view name, Texture all, float emission = 0.0f,
                          float glows_from = 0.0f) {
  return {name, kPlant, all, all, all, emission, 0.85f, {}, 0.0f, glows_from};
}
constexpr BlockType crystal(std::string_view name, Texture all, float roughness, float emission,
                            float glows_from) {
  return {name, kOpaque, all, all, all, emission, roughness, {}, 0.0f, glows_from};
}

// One row an id, in the order of block::. Emission is in units of the sun's radiance on white: a
// glow plant lights its corner, lava and lamps light a room, and a torch, being small, burns the
// brighter. Water takes red first, so that deep lakes turn blue-green. What a block of stained
// glass lets through has the colour of its texture, and the brighter that is the more.
constexpr std::array<BlockType, block::kBuiltInCount> kTable = {{
    {"air", kAir, T::kStone, T::kStone, T::kStone, 0.0f, 1.0f, {}},
    opaque("stone", T::kStone),
    opaque("stone_mossy", T::kStoneMossy),
    opaque("cobble", T::kCobble),
    opaque("gravel", T::kGravel, 0.95f),
    opaque("dirt", T::kDirt, 0.95f),
    sided("grass", T::kGrassSide, T::kGrassTop, T::kDirt),
    sided("dry_grass", T::kDryGrassSide, T::kDryGrassTop, T::kDirt),
    opaque("snow", T::kSnow, 0.7f),
    sided("snowy_grass", T::kSnowSide, T::kSnow, T::kDirt, 0.75f),
    opaque("ice", T::kIce, 0.15f),
    opaque("sand", T::kSand, 0.95f),
    sided("sandstone", T::kSandstoneSide, T::kSandstoneTop, T::kSandstoneTop),
    opaque("red_sand", T::kRedSand, 0.95f),
    opaque("red_rock", T::kRedRock),
    opaque("red_rock_banded", T::kRedRockBanded),
    opaque("clay", T::kClay, 0.8f),
    opaque("mud", T::kMud, 0.6f),
    sided("basalt", T::kBasalt, T::kBasaltTop, T::kBasaltTop, 0.8f),
    opaque("lava", T::kLava, 0.6f, 6.0f),
    opaque("obsidian", T::kObsidian, 0.12f),
    opaque("marble", T::kMarble, 0.35f),
    opaque("slate", T::kSlate, 0.75f),
    opaque("limestone", T::kLimestone),
    opaque("coal_ore", T::kCoalOre),
    ore("iron_ore", T::kIronOre, 0.75f, 0.3f),
    ore("copper_ore", T::kCopperOre, 0.75f, 0.4f),
    ore("gold_ore", T::kGoldOre, 0.6f, 0.6f),
    crystal("crystal_ore", T::kCrystalOre, 0.6f, 1.6f, 0.7f),
    crystal("crystal_blue", T::kCrystalBlue, 0.15f, 5.0f, 0.7f),
    crystal("crystal_violet", T::kCrystalViolet, 0.15f, 5.0f, 0.7f),
    opaque("glowstone", T::kGlowstone, 0.6f, 4.0f),
    log("oak_log", T::kOakLogSide, T::kOakLogTop),
    log("birch_log", T::kBirchLogSide, T::kBirchLogTop),
    log("pine_log", T::kPineLogSide, T::kPineLogTop),
    log("palm_log", T::kPalmLogSide, T::kPalmLogTop),
    log("willow_log", T::kWillowLogSide, T::kWillowLogTop),
    leaves("oak_leaves", T::kOakLeaves),
    leaves("birch_leaves", T::kBirchLeaves),
    leaves("pine_leaves", T::kPineLeaves),
    leaves("palm_leaves", T::kPalmLeaves),
    leaves("willow_leaves", T::kWillowLeaves),
    leaves("autumn_leaves", T::kAutumnLeaves),
    leaves("blossom_leaves", T::kBlossomLeaves),
    plant("tall_grass", T::kTallGrass),
    plant("fern", T::kFern),
    plant("flower_red", T::kFlowerRed),
    plant("flower_yellow", T::kFlowerYellow),
    plant("flower_blue", T::kFlowerBlue),
    plant("reed", T::kReed),
    plant("dead_bush", T::kDeadBush),
    plant("glow_shroom", T::kGlowShroom, 2.0f),
    plant("glow_fern", T::kGlowFern, 1.2f),
    plant("heather", T::kHeather),
    opaque("mushroom_cap_red", T::kMushroomCapRed, 0.6f),
    opaque("mushroom_cap_glow", T::kMushroomCapGlow, 0.6f, 1.8f),
    opaque("mushroom_stem", T::kMushroomStem, 0.8f),
    sided("mycelium", T::kMyceliumSide, T::kMyceliumTop, T::kDirt),
    liquid("water", T::kWater, {0.25f, 0.08f, 0.05f}, 0.038f),
    translucent("glass", T::kGlass, {0.05f, 0.02f, 0.03f}, 0.01f),
    sided("planks", T::kPlanks, T::kPlanks, T::kPlanks, 0.8f),
    opaque("bricks", T::kBricks, 0.85f),
    plant("torch", T::kTorch, 32.0f, 1.0f),
    opaque("lamp", T::kLamp, 0.5f, 8.0f),
    stained(0, "white_glass", {0.17f, 0.22f, 0.36f}),
    stained(1, "light_grey_glass", {0.46f, 0.50f, 0.60f}),
    stained(2, "grey_glass", {0.94f, 0.94f, 0.82f}),
    stained(3, "black_glass", {1.75f, 1.80f, 1.50f}),
    stained(4, "brown_glass", {0.87f, 1.79f, 2.59f}),
    stained(5, "red_glass", {0.57f, 2.83f, 3.15f}),
    stained(6, "orange_glass", {0.31f, 1.77f, 3.62f}),
    stained(7, "yellow_glass", {0.23f, 0.82f, 3.05f}),
    stained(8, "lime_glass", {0.82f, 0.50f, 2.61f}),
    stained(9, "green_glass", {1.71f, 0.88f, 2.49f}),
    stained(10, "teal_glass", {2.63f, 0.79f, 0.91f}),
    stained(11, "sky_glass", {1.56f, 0.71f, 0.34f}),
    stained(12, "blue_glass", {2.65f, 1.83f, 0.62f}),
    stained(13, "violet_glass", {1.37f, 2.11f, 0.67f}),
    stained(14, "plum_glass", {0.61f, 2.14f, 1.04f}),
    stained(15, "pink_glass", {0.24f, 1.18f, 0.97f}),
}};

constexpr unsigned kMostTranslucent = 31;
constexpr std::array kTranslucentBlocks = [] {
  std::array<BlockId, kMostTranslucent + 1> blocks{};
  unsigned number = 0;
  for (std::size_t id = 0; id < kTable.size(); ++id)
    if (kTable[id].kind == kTranslucent) blocks[++number] = static_cast<BlockId>(id);
  return blocks;
}();

}  // namespace

std::span<const BlockType> block_types() {
  return kTable;
}

BlockKind block_kind(BlockId id) {
  return id < kTable.size() ? kTable[id].kind : kOpaque;
}

unsigned translucent_number(BlockId id) {
  if (block_kind(id) != kTranslucent) return 0;
  return static_cast<unsigned>(std::ranges::find(kTranslucentBlocks, id) -
                               kTranslucentBlocks.begin());
}

BlockId translucent_block(unsigned number) {
  return number < kTranslucentBlocks.size() ? kTranslucentBlocks[number] : world::kAir;
}

bool is_solid(BlockId id) {
  const BlockKind kind = block_kind(id);
  return kind == kOpaque || kind == kCutout || is_glass(id);
}

bool is_glass(BlockId id) {
  return block_kind(id) == kTranslucent && !kTable[id].liquid;
}

bool is_stained_glass(BlockId id) {
  constexpr float kLeastSeen = 0.1f;  // absorption a block
  if (!is_glass(id)) return false;
  const std::array<float, 3>& absorption = kTable[id].absorption;
  return std::max({absorption[0], absorption[1], absorption[2]}) >= kLeastSeen;
}

}  // namespace skerry::world
