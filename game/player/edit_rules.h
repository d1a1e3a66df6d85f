// What digging and placing change, neighbours included.
#pragma once
#include <optional>

#include "game/player/edit_history.h"
#include "game/player/pick.h"

namespace skerry::game {

/// What digging a block changes: the block first, then what cannot stay without it: the plant
/// above, torches that had their only hold there. Empty: it cannot be dug.
EditAct dig_act(const Surroundings& around, std::uint64_t island, world::IVec3 voxel);

/// What placing a block at the picked one changes: one voxel, that of the plant picked or the one
/// beyond the picked face. Empty: it cannot stand there, because something is there, or nothing
/// holds it, or a solid of another island reaches in.
EditAct place_act(const Surroundings& around, const Pick& pick, world::BlockId block,
                  double time_s);

/// Whether a player's box leaves a voxel free at a time.
bool leaves_free(const Player& player, const Surroundings& around, std::uint64_t island,
                 world::IVec3 voxel);

}  // namespace skerry::game
