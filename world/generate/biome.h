#pragma once
#include <array>
#include <cstdint>

#include "world/voxel/blocks.h"

namespace skerry::world {

/// IslandSpec::biome of generated islands.
enum class Biome : std::uint8_t {
  kMeadow,
  kHighland,
  kMesa,
  kAutumn,
  kBlossom,
  kTropical,
  kMarsh,
  kVolcanic,
  kMycelium,
  kCount
};

/// What covers a column: the block seen from above and those just below it.
struct Skin {
  BlockId top, below;
  std::int16_t below_depth;  ///< voxels of `below` under the top
};
enum class SkinId : std::uint8_t {
  kGrass,
  kDryGrass,
  kSnowyGrass,
  kSnow,
  kSand,
  kRedSand,
  kGravel,
  kMud,
  kMycelium,
  kBasalt,
  kStone,
  kMossy,
  kClay,
  kObsidian,
  kLava,
  kBare,  ///< the rock itself
  kCount
};
/// Indexed by SkinId.
inline constexpr std::array<Skin, static_cast<std::size_t>(SkinId::kCount)> kSkins = {{
    {block::kGrass, block::kDirt, 3},
    {block::kDryGrass, block::kDirt, 3},
    {block::kSnowyGrass, block::kDirt, 3},
    {block::kSnow, block::kSnow, 1},
    {block::kSand, block::kSand, 2},
    {block::kRedSand, block::kRedSand, 1},
    {block::kGravel, block::kGravel, 2},
    {block::kMud, block::kClay, 2},
    {block::kMycelium, block::kDirt, 3},
    {block::kBasalt, block::kBasalt, 1},
    {block::kStone, block::kStone, 1},
    {block::kStoneMossy, block::kStoneMossy, 1},
    {block::kClay, block::kClay, 2},
    {block::kObsidian, block::kObsidian, 1},
    {block::kLava, block::kBasalt, 2},
    {block::kAirBlock, block::kAirBlock, -1},
}};

enum class TreeKind : std::uint8_t {
  kOak,
  kBirch,
  kPine,
  kPalm,
  kWillow,
  kBlossom,
  kAutumn,
  kShroomRed,
  kShroomGlow,
  kCount
};

struct TreeChance {
  TreeKind kind;
  std::uint8_t of_256;  ///< share of the trees; the last entry takes what is left
};
struct PlantChance {
  BlockId id;
  std::uint8_t of_256;  ///< chance for each fit column
};

/// What grows and lies on an island.
struct BiomeType {
  SkinId ground;
  SkinId beach;
  SkinId lake_bed;
  std::array<BlockId, 3> rock;  ///< main rock, and two that appear as bands
  BlockId liquid;               ///< fills the lakes
  std::uint8_t band_of_256;     ///< how much of the rock is bands
  std::uint8_t tree_of_256;     ///< chance for each fit site, before clearings
  std::array<TreeChance, 3> trees;
  std::array<PlantChance, 4> plants;  ///< on ground skins that bear plants
  BlockId crystal;                    ///< hangs below and glows in caves
};
const BiomeType& biome_type(Biome biome);

/// Whether grass, flowers and trees take root.
bool bears_plants(SkinId id);

}  // namespace skerry::world
