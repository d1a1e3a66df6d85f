#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "game/client/session_client.h"
#include "game/player/player.h"
#include "world/voxel/island.h"

namespace skerry::game {

/// The helm of an island: what drives it, and what the island really does.
class Helm {
 public:
  const std::optional<std::uint64_t>& island() const { return island_; }
  /// Of the island, as its place changed in the last frame that was watched [blocks/s].
  double speed() const { return speed_; }
  /// How fast it was when it bumped into something in that frame [blocks/s]; 0: it did not.
  double bump() const { return bump_; }
  /// Another island keeps it from moving though it is driven.
  bool held_fast() const;

  /// Nothing is driven before steer().
  void take(std::uint64_t island);
  /// Switches the engines off. Without an island nothing happens.
  void leave(SessionClient& session);
  /// What would move a player who looks that way moves the island. @param yaw_deg in its axes.
  void steer(const Intent& intent, double yaw_deg, SessionClient& session);
  /// What the island did in a frame. @param seconds of the world's time.
  /// @return a line for the player when it bumps into something, or begins to be held fast.
  std::optional<std::string> watch(const world::Pose& before, const world::Pose& now,
                                   double seconds);

 private:
  std::optional<std::uint64_t> island_;
  bool driven_ = false;  // by what is pressed now
  double speed_ = 0.0, bump_ = 0.0;
  double moves_s_ = 0.0;  // for so long, and so many frames, it has not stood still
  int move_frames_ = 0;
  std::optional<world::Pose> stands_at_;  // about there, since
  double held_s_ = 0.0;                   // for so long it has been driven and not moved
};

}  // namespace skerry::game
