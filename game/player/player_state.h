#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

#include "game/player/collide.h"
#include "world/voxel/coords.h"

namespace skerry::game {

/// Ground that held: a place of the feet on an island.
struct Footing {
  std::uint64_t island = 0;
  LatticePos lattice{0};
  bool operator==(const Footing&) const = default;
};

/// All that decides how a player goes on.
struct PlayerState {
  world::WorldPos feet;
  std::optional<std::uint64_t> island;  ///< in whose frame the player is
  LatticePos lattice{0};                ///< feet in that frame
  glm::dvec3 velocity{};                ///< in the frame's axes [blocks/s]
  double yaw_deg = 0.0;                 ///< relative to the frame
  double pitch_deg = 0.0;
  std::uint8_t mode = 0;             ///< of MoveMode
  double fly_speed = 12.0;           ///< blocks/s
  std::optional<Footing> safe = {};  ///< where they stood last; a fall ends there
  bool operator==(const PlayerState&) const = default;
};

}  // namespace skerry::game
