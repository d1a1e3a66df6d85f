// What of a play a world's file keeps besides the world.
#pragma once
#include <optional>

#include "game/scene_file/parse.h"
#include "game/session/hotbar.h"
#include "game/session/player_state.h"
#include "world/store/world_file.h"

namespace skerry::game {

struct SavedPlay {
  PlayerState player;
  CameraPlace eye;                 ///< for who only wants to look
  double time_of_day_s = 43200.0;  ///< 0 .. 86400
  double world_time_s = 0.0;       ///< how long the islands have drifted
  Hotbar hotbar;
  bool day_stands = false;  ///< stopped by the player
  bool operator==(const SavedPlay&) const = default;
};

void put_play(world::WorldFile::Transaction& transaction, const SavedPlay& play);
/// None: the world was never played, or what it says of it is damaged (and told).
std::optional<SavedPlay> saved_play(world::WorldFile& file);

}  // namespace skerry::game
