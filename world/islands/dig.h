// How blocks are dug, and what they need around them to stay.
#pragma once
#include "world/voxel/blocks.h"

namespace skerry::world {

/// How long someone digs at a block until it is gone [s]; 0: it goes at once. Short: worlds are
/// for exploring.
double dig_seconds(BlockId block);
/// Whether hands can take a block away: all but air and water.
bool can_dig(BlockId block);
/// Whether something placed may take a block's voxel: air, water, and plants but torches.
bool can_replace(BlockId block);

/// What a block must have beside it.
enum class Support : std::uint8_t {
  kNone,
  kGround,  ///< something solid below: plants
  kFace,    ///< something solid below or at one of its four sides: torches
};
Support support_of(BlockId block);

}  // namespace skerry::world
