// What of a play a world's file keeps besides the world.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

#include "game/parse.h"
#include "world/store/world_file.h"

namespace skerry::game {

/// All that decides how a player goes on.
struct PlayerState {
  world::WorldPos feet;
  std::optional<std::uint64_t> island;  ///< in whose frame the player is
  glm::dvec3 lattice{};                 ///< feet in that frame [blocks]
  glm::dvec3 velocity{};                ///< in the frame's axes [blocks/s]
  double yaw_deg = 0.0;                 ///< relative to the frame
  double pitch_deg = 0.0;
  bool flying = false;
  double fly_speed = 12.0;  ///< blocks/s
  bool operator==(const PlayerState&) const = default;
};

struct SavedPlay {
  PlayerState player;
  CameraPlace eye;                 ///< for who only wants to look
  double time_of_day_s = 43200.0;  ///< 0 .. 86400
  double world_time_s = 0.0;       ///< how long the islands have drifted
  bool operator==(const SavedPlay&) const = default;
};

void put_play(world::WorldFile::Transaction& transaction, const SavedPlay& play);
/// None: the world was never played, or what it says of it is damaged (and told).
std::optional<SavedPlay> saved_play(world::WorldFile& file);

}  // namespace skerry::game
