#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace skerry::world {

using BlockId = std::uint16_t;

/// How light and the mesher treat a block.
enum class BlockKind : std::uint8_t {
  kAir,     ///< nothing to draw
  kOpaque,  ///< hides the neighbour's face
  kCutout,  ///< has holes (leaves); drawn in the G-buffer with an alpha test; hides faces of its
            ///< own id only
  kPlant,   ///< two crossed diagonal quads, hides nothing, one voxel, no collision
  kTranslucent,  ///< glass, water: drawn in the translucent layers; hides faces of its own id only
};

inline constexpr BlockId kAir = 0;

/// A layer of the block texture array, see tools/textures. The enumerators' order is the layer
/// order.
enum class Texture : std::uint8_t {
  kStone,
  kStoneMossy,
  kCobble,
  kGravel,
  kDirt,
  kGrassTop,
  kGrassSide,
  kDryGrassTop,
  kDryGrassSide,
  kSnow,
  kSnowSide,
  kIce,
  kSand,
  kSandstoneTop,
  kSandstoneSide,
  kRedSand,
  kRedRock,
  kRedRockBanded,
  kClay,
  kMud,
  kBasalt,
  kBasaltTop,
  kLava,
  kObsidian,
  kMarble,
  kSlate,
  kLimestone,
  kCoalOre,
  kIronOre,
  kCopperOre,
  kGoldOre,
  kCrystalOre,
  kCrystalBlue,
  kCrystalViolet,
  kGlowstone,
  kOakLogSide,
  kOakLogTop,
  kBirchLogSide,
  kBirchLogTop,
  kPineLogSide,
  kPineLogTop,
  kPalmLogSide,
  kPalmLogTop,
  kWillowLogSide,
  kWillowLogTop,
  kOakLeaves,
  kBirchLeaves,
  kPineLeaves,
  kPalmLeaves,
  kWillowLeaves,
  kAutumnLeaves,
  kBlossomLeaves,
  kTallGrass,
  kFern,
  kFlowerRed,
  kFlowerYellow,
  kFlowerBlue,
  kReed,
  kDeadBush,
  kGlowShroom,
  kGlowFern,
  kHeather,
  kMushroomCapRed,
  kMushroomCapGlow,
  kMushroomStem,
  kMyceliumTop,
  kMyceliumSide,
  kWater,
  kGlass,
  kPlanks,
  kBricks,
  kTorch,
  kLamp,
  kCount,
  /// Layers in colours follow: 16 of wool, then 16 of stained glass, whose first this is.
  kStainedGlass = kCount + 16
};

/// The properties of a block id. World data, mesher, renderer and player all read this
/// table.
struct BlockType {
  std::string_view name;  ///< lower-case words joined by '_', unique
  BlockKind kind = BlockKind::kAir;
  Texture side{}, top{}, bottom{};
  float emission = 0.0f;              ///< radiance = albedo * this; 0: none
  float roughness = 0.9f;             ///< perceptual, 0..1
  std::array<float, 3> absorption{};  ///< translucent only: of light, linear RGB [1/block of path]
  float metalness = 0.0f;  ///< 0..1: how much of what it reflects is mirrored, in its own colour
  /// Texels whose brightest channel of albedo is this or more emit in full, darker ones less, and
  /// none does whose is lower by shared::kGlowRise or more: a torch's stick is wood. 0: all do.
  float glows_from = 0.0f;
  float scattering = 0.0f;  ///< translucent only: evenly to all sides, white [1/block of path]
  bool liquid = false;      ///< translucent only: players swim in it, and its level surface ripples
};

/// Named ids of the built-in blocks. The order is saved in worlds: append only.
namespace block {
enum : BlockId {
  kAirBlock = kAir,
  kStone,
  kStoneMossy,
  kCobble,
  kGravel,
  kDirt,
  kGrass,
  kDryGrass,
  kSnow,
  kSnowyGrass,
  kIce,
  kSand,
  kSandstone,
  kRedSand,
  kRedRock,
  kRedRockBanded,
  kClay,
  kMud,
  kBasalt,
  kLava,
  kObsidian,
  kMarble,
  kSlate,
  kLimestone,
  kCoalOre,
  kIronOre,
  kCopperOre,
  kGoldOre,
  kCrystalOre,
  kCrystalBlue,
  kCrystalViolet,
  kGlowstone,
  kOakLog,
  kBirchLog,
  kPineLog,
  kPalmLog,
  kWillowLog,
  kOakLeaves,
  kBirchLeaves,
  kPineLeaves,
  kPalmLeaves,
  kWillowLeaves,
  kAutumnLeaves,
  kBlossomLeaves,
  kTallGrass,
  kFern,
  kFlowerRed,
  kFlowerYellow,
  kFlowerBlue,
  kReed,
  kDeadBush,
  kGlowShroom,
  kGlowFern,
  kHeather,
  kMushroomCapRed,
  kMushroomCapGlow,
  kMushroomStem,
  kMycelium,
  kWater,
  kGlass,
  kPlanks,
  kBricks,
  kTorch,
  kLamp,
  kWhiteGlass,
  kLightGreyGlass,
  kGreyGlass,
  kBlackGlass,
  kBrownGlass,
  kRedGlass,
  kOrangeGlass,
  kYellowGlass,
  kLimeGlass,
  kGreenGlass,
  kTealGlass,
  kSkyGlass,
  kBlueGlass,
  kVioletGlass,
  kPlumGlass,
  kPinkGlass,
  kBuiltInCount
};
}  // namespace block

/// The table, indexed by block id; its size is block::kBuiltInCount.
std::span<const BlockType> block_types();
/// The kind of any id; ids outside the table count as opaque.
BlockKind block_kind(BlockId id);
/// The number of a translucent block among those of the table, in their order, from 1 on; 0: it is
/// not translucent. Faces name what they touch by it (shared::Quad).
unsigned translucent_number(BlockId id);
/// The block of that number; kAir if there is none.
BlockId translucent_block(unsigned number);
/// Whether a player can stand on it: opaque and cut-out blocks and glass.
bool is_solid(BlockId id);
/// Whether it is a translucent block that is no liquid.
bool is_glass(BlockId id);
/// Whether it is glass that takes a tenth or more of some colour on a block's way: stained glass.
/// Stored light takes its colour; that of clear glass is not seen.
bool is_stained_glass(BlockId id);

}  // namespace skerry::world
