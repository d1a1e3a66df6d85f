#include "world/islands/dig.h"

namespace skerry::world {
namespace {

constexpr double kBrittle = 0.15, kLoose = 0.25, kWood = 0.4, kRock = 0.5, kHard = 0.7,
                 kHardest = 1.2;

}  // namespace

double dig_seconds(BlockId id) {
  if (block_kind(id) == BlockKind::kPlant) return 0.0;
  if (block_kind(id) == BlockKind::kCutout) return 0.1;
  if (is_glass(id)) return kBrittle;
  switch (id) {
    case block::kLamp:
    case block::kSnow:
    case block::kMushroomCapRed:
    case block::kMushroomCapGlow:
    case block::kMushroomStem:
      return kBrittle;
    case block::kGravel:
    case block::kDirt:
    case block::kGrass:
    case block::kDryGrass:
    case block::kSnowyGrass:
    case block::kSand:
    case block::kRedSand:
    case block::kClay:
    case block::kMud:
    case block::kMycelium:
      return kLoose;
    case block::kOakLog:
    case block::kBirchLog:
    case block::kPineLog:
    case block::kPalmLog:
    case block::kWillowLog:
    case block::kPlanks:
      return kWood;
    case block::kBasalt:
    case block::kMarble:
    case block::kCoalOre:
    case block::kIronOre:
    case block::kCopperOre:
    case block::kGoldOre:
    case block::kCrystalOre:
      return kHard;
    case block::kObsidian:
      return kHardest;
    default:
      return kRock;
  }
}

bool can_dig(BlockId id) {
  return id != kAir && id != block::kWater;
}

bool can_replace(BlockId id) {
  return !can_dig(id) || (block_kind(id) == BlockKind::kPlant && id != block::kTorch);
}

Support support_of(BlockId id) {
  if (id == block::kTorch) return Support::kFace;
  return block_kind(id) == BlockKind::kPlant ? Support::kGround : Support::kNone;
}

}  // namespace skerry::world
