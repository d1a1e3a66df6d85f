#include "world/generate/biome.h"

namespace skerry::world {
namespace {

using namespace block;

using enum TreeKind;

constexpr std::array<BiomeType, static_cast<std::size_t>(Biome::kCount)> kBiomes = {{
    // meadow
    {SkinId::kGrass,
     SkinId::kSand,
     SkinId::kGravel,
     {kStone, kStoneMossy, kLimestone},
     kWater,
     40,
     90,
     {{{kOak, 180}, {kBirch, 255}, {kOak, 0}}},
     {{{kTallGrass, 52}, {kFlowerYellow, 6}, {kFlowerRed, 5}, {kFlowerBlue, 4}}},
     kCrystalBlue},
    // highland
    {SkinId::kGrass,
     SkinId::kGravel,
     SkinId::kGravel,
     {kStone, kSlate, kStoneMossy},
     kWater,
     70,
     150,
     {{{kPine, 225}, {kBirch, 255}, {kPine, 0}}},
     {{{kTallGrass, 30}, {kHeather, 24}, {kFern, 16}, {kFlowerBlue, 3}}},
     kCrystalBlue},
    // mesa
    {SkinId::kRedSand,
     SkinId::kRedSand,
     SkinId::kClay,
     {kRedRock, kRedRockBanded, kSandstone},
     kWater,
     150,
     26,
     {{{kOak, 255}, {kOak, 0}, {kOak, 0}}},
     {{{kDeadBush, 8}, {kTallGrass, 3}, {kFlowerYellow, 1}, {kHeather, 2}}},
     kGlowstone},
    // autumn
    {SkinId::kGrass,
     SkinId::kGravel,
     SkinId::kMud,
     {kStone, kSlate, kLimestone},
     kWater,
     50,
     170,
     {{{kAutumn, 200}, {kBirch, 235}, {kOak, 255}}},
     {{{kTallGrass, 34}, {kFern, 22}, {kHeather, 8}, {kFlowerRed, 4}}},
     kCrystalViolet},
    // blossom
    {SkinId::kGrass,
     SkinId::kSand,
     SkinId::kSand,
     {kLimestone, kMarble, kStone},
     kWater,
     60,
     120,
     {{{kBlossom, 215}, {kBirch, 240}, {kWillow, 255}}},
     {{{kTallGrass, 40}, {kFlowerRed, 10}, {kFlowerBlue, 10}, {kFlowerYellow, 5}}},
     kCrystalViolet},
    // tropical
    {SkinId::kGrass,
     SkinId::kSand,
     SkinId::kSand,
     {kLimestone, kSandstone, kStoneMossy},
     kWater,
     70,
     110,
     {{{kPalm, 190}, {kOak, 255}, {kPalm, 0}}},
     {{{kFern, 36}, {kTallGrass, 36}, {kFlowerRed, 9}, {kFlowerYellow, 9}}},
     kCrystalBlue},
    // marsh
    {SkinId::kGrass,
     SkinId::kMud,
     SkinId::kMud,
     {kStoneMossy, kStone, kClay},
     kWater,
     60,
     110,
     {{{kWillow, 200}, {kOak, 255}, {kWillow, 0}}},
     {{{kTallGrass, 60}, {kFern, 36}, {kReed, 10}, {kGlowFern, 5}}},
     kGlowstone},
    // volcanic
    {SkinId::kBasalt,
     SkinId::kObsidian,
     SkinId::kBasalt,
     {kBasalt, kSlate, kObsidian},
     kLava,
     60,
     10,
     {{{kPine, 255}, {kPine, 0}, {kPine, 0}}},
     {{{kDeadBush, 6}, {kTallGrass, 3}, {kHeather, 3}, {kGlowFern, 2}}},
     kGlowstone},
    // mycelium
    {SkinId::kMycelium,
     SkinId::kClay,
     SkinId::kClay,
     {kSlate, kStone, kCrystalOre},
     kWater,
     30,
     130,
     {{{kShroomRed, 120}, {kShroomGlow, 255}, {kShroomRed, 0}}},
     {{{kGlowShroom, 14}, {kGlowFern, 14}, {kFern, 14}, {kHeather, 3}}},
     kCrystalViolet},
}};

}  // namespace

const Skin& skin(SkinId id) {
  return kSkins[static_cast<std::size_t>(id)];
}
const BiomeType& biome_type(Biome biome) {
  return kBiomes[static_cast<std::size_t>(biome)];
}

bool bears_plants(SkinId id) {
  return id == SkinId::kGrass || id == SkinId::kDryGrass || id == SkinId::kMycelium;
}

}  // namespace skerry::world
