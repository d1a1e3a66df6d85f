#pragma once
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "game/sound/sound_scene.h"

namespace skerry::game {

/// What a player does in a frame, as far as it makes a sound.
struct PlayMoment {
  double seconds = 0.0;
  glm::dvec3 velocity{};  ///< relative to what carries the player [blocks/s]
  bool walks = true;      ///< neither flies nor passes through walls
  bool on_ground = false, in_water = false, crouching = false;
  world::BlockId ground = world::kAir;        ///< below the feet
  double dig_progress = 0.0;                  ///< of what is pointed at, 0 .. 1
  world::BlockId dug = world::kAir;           ///< what is pointed at
  std::optional<world::WorldPos> pointed_at;  ///< in the open before its face
  double bump = 0.0;  ///< of the island that is steered, into something else [blocks/s]
};

/// An edit that was done.
struct EditHeard {
  world::BlockId was = world::kAir, is = world::kAir;
  world::WorldPos at;
};

/// Turns what a player does into sounds: steps by the way walked, blows of digging by time.
class PlaySounds {
 public:
  /// The sounds of a frame.
  std::vector<SoundEvent> advance(const PlayMoment& now, const std::vector<EditHeard>& edits);

  /// Blocks between two steps when walking; sprinting makes longer ones, crouching shorter.
  static constexpr double kStride = 2.0;
  static constexpr double kBlowPeriod = 0.22;   ///< seconds between blows of digging
  static constexpr std::size_t kMostEdits = 4;  ///< that are heard in a frame

 private:
  void step(const PlayMoment& now, std::vector<SoundEvent>& out);
  void enter_water(const PlayMoment& now, std::vector<SoundEvent>& out);
  void dig(const PlayMoment& now, std::vector<SoundEvent>& out);

  double walked_ = 0.0;      // since the last step [blocks]
  double until_blow_ = 0.0;  // seconds
  double fall_ = 0.0;        // downward speed of the frame before [blocks/s]
  bool on_ground_ = true, in_water_ = false, begun_ = false;
  unsigned steps_ = 0;
};

}  // namespace skerry::game
