// What of a play a world's file keeps besides the world.
#pragma once
#include <map>
#include <optional>
#include <string>

#include "game/player/camera_place.h"
#include "game/player/hotbar.h"
#include "game/player/player_state.h"
#include "world/store/world_file.h"

namespace skerry::game {

inline constexpr std::size_t kMaxPlayerBytes = 64;
inline constexpr std::size_t kMaxPlayers = 4096;  ///< whose places one world keeps

struct SavedPlay {
  PlayerState player;
  CameraPlace eye;                 ///< where a picture is taken from
  double time_of_day_s = 43200.0;  ///< 0 .. 86400
  double world_time_s = 0.0;       ///< how long the islands have drifted
  Hotbar hotbar;
  bool day_stands = false;  ///< stopped by the player
  bool operator==(const SavedPlay&) const = default;
};

/// Of each player by name; the empty name is the player of a world that is played alone.
/// @pre at most kMaxPlayers names of at most kMaxPlayerBytes.
void put_plays(world::WorldFile::Transaction& transaction,
               const std::map<std::string, SavedPlay>& plays);
/// Damaged ones are left out, with a line in WorldFile::damage().
std::map<std::string, SavedPlay> saved_plays(world::WorldFile& file);
/// The one of the empty name.
std::optional<SavedPlay> saved_play(world::WorldFile& file);

}  // namespace skerry::game
