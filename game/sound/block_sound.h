// How blocks sound, and how sound goes through them.
#pragma once
#include "game/sound/sound_names.h"
#include "world/voxel/blocks.h"

namespace skerry::game {

/// What a voxel is to sound.
enum class SoundMedium : std::uint8_t {
  kAir,     ///< and plants, torches
  kLeaves,  ///< lets it pass, with a loss
  kWater,   ///< lets it pass; the surface costs kSurfaceLossDb
  kSolid
};
SoundMedium medium_of(world::BlockId block);

/// What is lost on the way through a block's voxel [dB/block]. One solid block loses at least 42.
double loss_db_per_block(world::BlockId block);
/// What air and water lose to each other at a surface [dB].
inline constexpr double kSurfaceLossDb = 12.0;
/// Share of the energy that a face of the block swallows, 0 .. 1.
double absorption_of(world::BlockId block);

SoundMaterial sound_material(world::BlockId block);

}  // namespace skerry::game
