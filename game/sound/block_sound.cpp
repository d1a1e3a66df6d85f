#include "game/sound/block_sound.h"

#include <array>

namespace skerry::game {
namespace {

namespace block = world::block;

/// What a solid of the material loses [dB/block], and swallows of what meets its face. Losses are
/// those of real walls of a metre, cut off where nothing is heard any more; absorption as tables of
/// room acoustics have it at 500 Hz (H. Kuttruff, Room Acoustics), with rough surfaces.
struct MaterialSound {
  double loss_db, absorption;
};
constexpr std::array<MaterialSound, kSoundMaterials> kMaterialSounds{{{54.0, 0.12},
                                                                      {46.0, 0.35},
                                                                      {46.0, 0.30},
                                                                      {42.0, 0.15},
                                                                      {1.5, 0.30},
                                                                      {44.0, 0.60},
                                                                      {0.0, 0.03}}};

}  // namespace

SoundMedium medium_of(world::BlockId id) {
  if (id == world::kAir) return SoundMedium::kAir;
  if (id == block::kWater) return SoundMedium::kWater;
  if (!world::is_solid(id)) return SoundMedium::kAir;
  return world::block_kind(id) == world::BlockKind::kCutout ? SoundMedium::kLeaves
                                                            : SoundMedium::kSolid;
}

double loss_db_per_block(world::BlockId id) {
  switch (medium_of(id)) {
    case SoundMedium::kSolid:
    case SoundMedium::kLeaves:
      return kMaterialSounds[static_cast<std::size_t>(sound_material(id))].loss_db;
    default:
      return 0.0;
  }
}

double absorption_of(world::BlockId id) {
  return kMaterialSounds[static_cast<std::size_t>(sound_material(id))].absorption;
}

SoundMaterial sound_material(world::BlockId id) {
  if (id == block::kWater) return SoundMaterial::kWater;
  if (world::block_kind(id) == world::BlockKind::kCutout) return SoundMaterial::kLeaves;
  if (world::block_kind(id) == world::BlockKind::kPlant)
    return id == block::kTorch ? SoundMaterial::kWood : SoundMaterial::kLeaves;
  if (id >= block::kOakLog && id <= block::kWillowLog) return SoundMaterial::kWood;
  switch (id) {
    case block::kPlanks:
    case block::kMushroomCapRed:
    case block::kMushroomCapGlow:
    case block::kMushroomStem:
      return SoundMaterial::kWood;
    case block::kDirt:
    case block::kGrass:
    case block::kDryGrass:
    case block::kClay:
    case block::kMud:
    case block::kMycelium:
      return SoundMaterial::kSoil;
    case block::kSand:
    case block::kRedSand:
    case block::kGravel:
      return SoundMaterial::kSand;
    case block::kSnow:
    case block::kSnowyGrass:
      return SoundMaterial::kSnow;
    default:
      return SoundMaterial::kStone;
  }
}

}  // namespace skerry::game
