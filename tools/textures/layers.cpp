#include "tools/textures/layers.h"

#include <iterator>
#include <string_view>

#include "engine/core/check.h"
#include "engine/render/scene/block_textures.h"
#include "tools/textures/painters.h"
#include "world/voxel/blocks.h"

namespace skerry::textures {
namespace {

using world::Texture;

constexpr Color kGrass = hex(0x6f8d45), kGrassOther = hex(0x87964a);
constexpr Color kDryGrass = hex(0xab9a58), kDryGrassOther = hex(0x9a8350);
constexpr Color kSnowCover = hex(0xe6ecf1), kStoneBase = hex(0x8b8984);

struct Named {
  Texture texture;
  std::string_view name;
  Canvas (*paint)();
};

const Named kNamed[] = {
    {Texture::kStone, "stone", [] { return paint_stone(kStoneBase, 11); }},
    {Texture::kStoneMossy, "stone_mossy",
     [] { return paint_mossy(paint_stone(kStoneBase, 11), 21); }},
    {Texture::kCobble, "cobble", [] { return paint_cobble(hex(0x87847e), 31); }},
    {Texture::kGravel, "gravel", [] { return paint_gravel(hex(0x8d867d), hex(0x777880), 41); }},
    {Texture::kDirt, "dirt", [] { return paint_dirt(); }},
    {Texture::kGrassTop, "grass_top", [] { return paint_grass_top(kGrass, kGrassOther, 51); }},
    {Texture::kGrassSide, "grass_side",
     [] { return paint_covered_side(kGrass, kGrassOther, 7.0f, true, 52); }},
    {Texture::kDryGrassTop, "dry_grass_top",
     [] { return paint_grass_top(kDryGrass, kDryGrassOther, 61); }},
    {Texture::kDryGrassSide, "dry_grass_side",
     [] { return paint_covered_side(kDryGrass, kDryGrassOther, 6.0f, true, 62); }},
    {Texture::kSnow, "snow", [] { return paint_snow(); }},
    {Texture::kSnowSide, "snow_side",
     [] { return paint_covered_side(kSnowCover, hex(0xd3dde8), 9.0f, false, 72); }},
    {Texture::kIce, "ice", [] { return paint_ice(); }},
    {Texture::kSand, "sand", [] { return paint_sand(hex(0xdac799), 81); }},
    {Texture::kSandstoneTop, "sandstone_top",
     [] { return paint_smooth_ground(hex(0xd3bb89), 82); }},
    {Texture::kSandstoneSide, "sandstone_side", [] { return paint_sandstone_side(); }},
    {Texture::kRedSand, "red_sand", [] { return paint_sand(hex(0xb97a52), 84); }},
    {Texture::kRedRock, "red_rock", [] { return paint_stone(hex(0xa05c43), 85); }},
    {Texture::kRedRockBanded, "red_rock_banded", [] { return paint_banded_rock(); }},
    {Texture::kClay, "clay", [] { return paint_smooth_ground(hex(0xa19a93), 86); }},
    {Texture::kMud, "mud", [] { return paint_mud(); }},
    {Texture::kBasalt, "basalt", [] { return paint_basalt_side(); }},
    {Texture::kBasaltTop, "basalt_top", [] { return paint_basalt_top(); }},
    {Texture::kLava, "lava", [] { return paint_lava(); }},
    {Texture::kObsidian, "obsidian", [] { return paint_obsidian(); }},
    {Texture::kMarble, "marble", [] { return paint_marble(); }},
    {Texture::kSlate, "slate", [] { return paint_slate(); }},
    {Texture::kLimestone, "limestone", [] { return paint_limestone(); }},
    {Texture::kCoalOre, "coal_ore",
     [] { return paint_ore(ramp(hex(0x35333a), 0.6f), 0.25f, 101); }},
    {Texture::kIronOre, "iron_ore",
     [] { return paint_ore(ramp(hex(0xb58a6c), 0.66f), 0.4f, 102); }},
    {Texture::kCopperOre, "copper_ore",
     [] {
       return paint_ore(
           {{hex(0x3f4f49), hex(0x5c7f70), hex(0xb0714a), hex(0xcf8f60), hex(0xe6b58a)}}, 0.5f,
           103);
     }},
    {Texture::kGoldOre, "gold_ore",
     [] {
       return paint_ore(
           {{hex(0x7a5426), hex(0xb4852f), hex(0xd9b04a), hex(0xf0d27a), hex(0xfff1b8)}}, 0.9f,
           104);
     }},
    {Texture::kCrystalOre, "crystal_ore", [] { return paint_crystal_ore(hex(0x7fb4c4), 105); }},
    {Texture::kCrystalBlue, "crystal_blue", [] { return paint_crystal(hex(0x6aa3c6), 106); }},
    {Texture::kCrystalViolet, "crystal_violet", [] { return paint_crystal(hex(0x957cc0), 107); }},
    {Texture::kGlowstone, "glowstone", [] { return paint_glowstone(hex(0xecc074), 108); }},
    {Texture::kOakLogSide, "oak_log_side",
     [] { return paint_bark(hex(0x705741), Bark::kRidged, 201); }},
    {Texture::kOakLogTop, "oak_log_top",
     [] { return paint_log_top(hex(0xb08d5d), hex(0x705741), 202); }},
    {Texture::kBirchLogSide, "birch_log_side",
     [] { return paint_bark(hex(0xd2ccc0), Bark::kBirch, 203); }},
    {Texture::kBirchLogTop, "birch_log_top",
     [] { return paint_log_top(hex(0xcdb58c), hex(0xc8c1b4), 204); }},
    {Texture::kPineLogSide, "pine_log_side",
     [] { return paint_bark(hex(0x7f5a45), Bark::kPlated, 205); }},
    {Texture::kPineLogTop, "pine_log_top",
     [] { return paint_log_top(hex(0xb88a58), hex(0x7f5a45), 206); }},
    {Texture::kPalmLogSide, "palm_log_side",
     [] { return paint_bark(hex(0x9a8465), Bark::kRinged, 207); }},
    {Texture::kPalmLogTop, "palm_log_top",
     [] { return paint_log_top(hex(0xc0a273), hex(0x9a8465), 208); }},
    {Texture::kWillowLogSide, "willow_log_side",
     [] { return paint_bark(hex(0x6d685a), Bark::kFibrous, 209); }},
    {Texture::kWillowLogTop, "willow_log_top",
     [] { return paint_log_top(hex(0xa99a6f), hex(0x6d685a), 210); }},
    {Texture::kOakLeaves, "oak_leaves",
     [] { return paint_leaves(hex(0x5f7f3c), hex(0x778d44), Leaf::kRound, 221); }},
    {Texture::kBirchLeaves, "birch_leaves",
     [] { return paint_leaves(hex(0x84994a), hex(0x9ca653), Leaf::kRound, 222); }},
    {Texture::kPineLeaves, "pine_leaves",
     [] { return paint_leaves(hex(0x47694c), hex(0x567350), Leaf::kNeedle, 223); }},
    {Texture::kPalmLeaves, "palm_leaves",
     [] { return paint_leaves(hex(0x6a8d45), hex(0x83994c), Leaf::kFrond, 224); }},
    {Texture::kWillowLeaves, "willow_leaves",
     [] { return paint_leaves(hex(0x748a52), hex(0x8b9862), Leaf::kWillow, 225); }},
    {Texture::kAutumnLeaves, "autumn_leaves",
     [] { return paint_leaves(hex(0xb3683a), hex(0xc2923f), Leaf::kRound, 226); }},
    {Texture::kBlossomLeaves, "blossom_leaves",
     [] { return paint_leaves(hex(0xd79fae), hex(0xe6c3c6), Leaf::kBlossom, 227); }},
    {Texture::kTallGrass, "tall_grass", [] { return paint_tall_grass(hex(0x7c9549), 231); }},
    {Texture::kFern, "fern", [] { return paint_fern(hex(0x5d8044), hex(0x7f9a50), 232); }},
    {Texture::kFlowerRed, "flower_red",
     [] { return paint_flower(hex(0xb8483c), hex(0x35292c), Flower::kPoppy, 233); }},
    {Texture::kFlowerYellow, "flower_yellow",
     [] { return paint_flower(hex(0xd9b445), hex(0x8a5a30), Flower::kDaisy, 234); }},
    {Texture::kFlowerBlue, "flower_blue",
     [] { return paint_flower(hex(0x6a83bd), hex(0xd8c878), Flower::kBell, 235); }},
    {Texture::kReed, "reed", [] { return paint_reed(); }},
    {Texture::kDeadBush, "dead_bush", [] { return paint_dead_bush(); }},
    {Texture::kGlowShroom, "glow_shroom", [] { return paint_glow_shroom(); }},
    {Texture::kGlowFern, "glow_fern", [] { return paint_fern(hex(0x3d7d78), hex(0x8fe6cf), 236); }},
    {Texture::kHeather, "heather", [] { return paint_heather(); }},
    {Texture::kMushroomCapRed, "mushroom_cap_red",
     [] { return paint_mushroom_cap(hex(0xa8483c), hex(0xe2d8c6), 241); }},
    {Texture::kMushroomCapGlow, "mushroom_cap_glow",
     [] { return paint_mushroom_cap(hex(0x3f7f86), hex(0xb4f2dc), 242); }},
    {Texture::kMushroomStem, "mushroom_stem", [] { return paint_mushroom_stem(); }},
    {Texture::kMyceliumTop, "mycelium_top", [] { return paint_mycelium_top(); }},
    {Texture::kMyceliumSide, "mycelium_side",
     [] { return paint_covered_side(hex(0x857890), hex(0x9a8d9c), 6.0f, false, 243); }},
    {Texture::kWater, "water", [] { return paint_water(); }},
    {Texture::kGlass, "glass", [] { return paint_glass(hex(0xd3dfde), hex(0xe9efec), 0.02f); }},
    {Texture::kPlanks, "planks", [] { return paint_planks(hex(0xaa8658), 251); }},
    {Texture::kBricks, "bricks", [] { return paint_bricks(hex(0x9c5a47), hex(0xb5aa9a), 252); }},
    {Texture::kTorch, "torch", [] { return paint_torch(); }},
    {Texture::kLamp, "lamp", [] { return paint_lamp(hex(0xf2c678), hex(0x4f4a47)); }},
};
static_assert(std::size(kNamed) == static_cast<std::size_t>(Texture::kCount));

struct Dye {
  std::string_view name;
  Color color;
};
constexpr Dye kDyes[] = {
    {"white", hex(0xdcd8ce)},  {"light_grey", hex(0xa9a7a1)}, {"grey", hex(0x75757a)},
    {"black", hex(0x39383f)},  {"brown", hex(0x74533d)},      {"red", hex(0x99433b)},
    {"orange", hex(0xc2743a)}, {"yellow", hex(0xd0aa4c)},     {"lime", hex(0x92a34c)},
    {"green", hex(0x55733f)},  {"teal", hex(0x3f7d78)},       {"sky", hex(0x7ba6bd)},
    {"blue", hex(0x465f93)},   {"violet", hex(0x6d538c)},     {"plum", hex(0x94557f)},
    {"pink", hex(0xce95a0)}};

void add_dyed(std::vector<Layer>& layers) {
  std::uint32_t seed = 2000;
  const auto add = [&](std::string_view suffix, auto&& paint) {
    for (const Dye& dye : kDyes)
      layers.push_back(
          {std::string(dye.name) + '_' + std::string(suffix), paint(dye.color, seed++)});
  };
  add("wool", [](Color dye, std::uint32_t) { return paint_wool(dye, 2000); });
  add("stained_glass", [](Color dye, std::uint32_t) {
    return paint_glass(mix(dye, hex(0xf0eee6), 0.2f), mix(dye, hex(0xf0eee6), 0.2f), 0.15f);
  });
  add("glazed_tile", [](Color dye, std::uint32_t s) { return paint_glazed_tile(dye, s); });
  add("plaster", [](Color dye, std::uint32_t s) { return paint_plaster(dye, s); });
  add("terracotta", [](Color dye, std::uint32_t s) { return paint_terracotta(dye, s); });
}

void add_masonry(std::vector<Layer>& layers) {
  struct Stone {
    std::string_view name;
    Ramp tones;
  };
  const Stone stones[] = {
      {"stone", ramp(kStoneBase, 0.6f)},
      {"marble", {{hex(0x98959a), hex(0xb9b6b4), hex(0xd6d3ce), hex(0xe3e0da), hex(0xf1efea)}}},
      {"slate", ramp(hex(0x66707a), 0.6f)},
      {"limestone", ramp(hex(0xc3b79f), 0.5f)},
      {"sandstone", ramp(hex(0xcfb583), 0.55f)},
      {"red_rock", ramp(hex(0xa05c43), 0.6f)},
      {"basalt", ramp(hex(0x55545a), 0.66f)},
      {"obsidian", {{hex(0x15121b), hex(0x221d2b), hex(0x302a3b), hex(0x51475f), hex(0x8a7f97)}}}};
  struct Style {
    std::string_view name;
    Masonry style;
  };
  constexpr Style kStyles[] = {{"polished", Masonry::kPolished},
                               {"bricks", Masonry::kBricks},
                               {"tiles", Masonry::kTiles},
                               {"carved", Masonry::kCarved},
                               {"pillar", Masonry::kPillar}};
  std::uint32_t seed = 3000;
  for (const Style& style : kStyles)
    for (const Stone& stone : stones)
      layers.push_back({std::string(stone.name) + '_' + std::string(style.name),
                        paint_masonry(stone.tones, style.style, seed++)});
}

void add_wood_and_roofs(std::vector<Layer>& layers) {
  constexpr Dye kWoods[] = {{"birch", hex(0xcdb78f)},       {"pine", hex(0xb48552)},
                            {"palm", hex(0xbf9d70)},        {"willow", hex(0x9c9168)},
                            {"walnut", hex(0x694a38)},      {"driftwood", hex(0x9b9488)},
                            {"whitewashed", hex(0xd5d0c4)}, {"charred", hex(0x413c3c)}};
  std::uint32_t seed = 4000;
  for (const Dye& wood : kWoods)
    layers.push_back({std::string(wood.name) + "_planks", paint_planks(wood.color, seed++)});
  constexpr Dye kRoofs[] = {{"clay", hex(0xa9583f)},  {"slate", hex(0x5d6873)},
                            {"moss", hex(0x6b7649)},  {"cedar", hex(0x87614a)},
                            {"ochre", hex(0xb98f4c)}, {"teal", hex(0x4a7472)},
                            {"plum", hex(0x6b4a60)},  {"ash", hex(0x99958e)}};
  for (const Dye& roof : kRoofs)
    layers.push_back({std::string(roof.name) + "_shingles", paint_shingles(roof.color, seed++)});
}

void add_metals(std::vector<Layer>& layers) {
  constexpr Dye kMetals[] = {{"iron", hex(0x8f9194)},   {"steel", hex(0x6f7882)},
                             {"copper", hex(0xb3714e)}, {"verdigris", hex(0x6b9a89)},
                             {"bronze", hex(0x8d6d42)}, {"gold", hex(0xd5ab4d)},
                             {"silver", hex(0xbfc3c6)}, {"rust", hex(0x8a5238)}};
  std::uint32_t seed = 5000;
  for (const Dye& metal : kMetals)
    layers.push_back({std::string(metal.name) + "_plate", paint_metal_plate(metal.color, seed++)});
  for (const Dye& metal : kMetals)
    layers.push_back({std::string(metal.name) + "_tread", paint_metal_tread(metal.color, seed++)});
}

void add_crafts_and_nature(std::vector<Layer>& layers) {
  const auto add = [&](std::string_view name, const Canvas& canvas) {
    layers.push_back({std::string(name), canvas});
  };
  add("thatch", paint_thatch(hex(0xb59a5d), false, 6001));
  add("thatch_ends", paint_thatch(hex(0xb59a5d), true, 6002));
  add("basket", paint_basket(hex(0xa8834f), 6003));
  add("rope", paint_rope(hex(0xa78d62)));
  add("bookshelf", paint_bookshelf(hex(0x9a7549)));
  add("crate", paint_crate(hex(0xaa8658), hex(0x86643f), 6004));
  add("barrel_side", paint_barrel_side(hex(0x96703f), hex(0x5c5a5a)));
  add("barrel_top", paint_barrel_top(hex(0xa07a4b), hex(0x5c5a5a)));
  add("parquet", paint_parquet(hex(0xaf8654), hex(0x94683f), 6005));
  add("sailcloth", paint_sailcloth(hex(0xd6cbb2), 6006));
  add("red_sailcloth", paint_sailcloth(hex(0x9d5246), 6007));
  add("wood_lattice", paint_lattice(hex(0x97764e), true));
  add("iron_grate", paint_lattice(hex(0x6c6d70), false));
  add("paper_lamp", paint_lamp(hex(0xf0d9ae), hex(0x6f5238)));
  add("cold_lamp", paint_lamp(hex(0xa9d6dc), hex(0x54616a)));
  add("ember_stone", paint_glowstone(hex(0xe0824a), 6008));
  add("moon_stone", paint_glowstone(hex(0xb5d3dc), 6009));
  add("crystal_rose", paint_crystal(hex(0xc9849c), 6010));
  add("crystal_green", paint_crystal(hex(0x72b08a), 6011));
  add("moss", paint_moss(hex(0x74804c), 6012));
  add("leaf_litter", paint_leaf_litter());
  add("peat", paint_smooth_ground(hex(0x4f4038), 6013));
  add("ash", paint_smooth_ground(hex(0x77757a), 6014));
  add("cracked_earth", paint_cracked_ground(hex(0xb39872), 6015));
  add("salt", paint_salt());
  add("river_pebbles", paint_gravel(hex(0xa3998a), hex(0x72858c), 6016));
  add("mossy_cobble", paint_mossy(paint_cobble(hex(0x87847e), 31), 6017));
  add("grey_bricks", paint_bricks(hex(0x7c7a7c), hex(0xa29d95), 6018));
  add("flower_white", paint_flower(hex(0xe4ddd0), hex(0xd0a640), Flower::kTulip, 6019));
  add("wheat", paint_wheat());
  add("kelp", paint_kelp());
}

}  // namespace

std::vector<Layer> paint_layers() {
  std::vector<Layer> layers;
  for (const Named& named : kNamed) {
    SKERRY_ASSERT(static_cast<std::size_t>(named.texture) == layers.size());
    layers.push_back({std::string(named.name), named.paint()});
  }
  add_dyed(layers);
  add_masonry(layers);
  add_wood_and_roofs(layers);
  add_metals(layers);
  add_crafts_and_nature(layers);
  SKERRY_ASSERT(layers.size() == render::kBlockTextureLayers);
  return layers;
}

}  // namespace skerry::textures
