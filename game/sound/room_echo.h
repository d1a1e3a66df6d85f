#pragma once
#include <glm/vec3.hpp>

#include "game/sound/sound_room.h"

namespace skerry::game {

/// What rays from the listener say of the space around.
struct RoomEcho {
  double volume = 0.0;      ///< blocks^3, up to what the rays meet
  double surface = 0.0;     ///< blocks^2
  double open = 1.0;        ///< share of the surface that is sky
  double absorption = 1.0;  ///< mean of the surface, sky included: 0 .. 1
  double decay_s = 0.1;     ///< in which an echo falls by 60 dB
  double level = 0.0;       ///< amplitude of the echo to what is sent, 0 .. 1
};

/// By kEchoRays fixed rays of up to kEchoReach blocks. Exact, but for their number, where the
/// listener sees all walls.
inline constexpr int kEchoRays = 256;
inline constexpr double kEchoReach = 30.0;
RoomEcho room_echo(const SoundRoom& room, const glm::dvec3& listener);

}  // namespace skerry::game
