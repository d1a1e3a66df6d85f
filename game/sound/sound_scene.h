// From what happens around a listener to what the mixer shall do. One thread; no device.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "game/sound/mixer.h"
#include "game/sound/room_echo.h"
#include "game/sound/room_keeper.h"
#include "game/sound/sound_paths.h"

namespace skerry::game {

/// Something that is heard once.
struct SoundEvent {
  Sound sound = Sound::kStep;
  SoundMaterial material = SoundMaterial::kStone;
  std::optional<world::WorldPos> at;  ///< none: at the listener
  float gain = 1.0f;                  ///< amplitude at a block's distance
  float speed = 1.0f;                 ///< pitch
};

/// A frame of play, as it is heard.
struct SoundFrame {
  std::shared_ptr<world::World> world;  ///< none: no world is played
  RoomKeeper::Listener listener;
  double yaw_deg = 0.0;
  double air_speed = 0.0;  ///< blocks/s
  bool paused = false;     ///< the world is silent
  bool strains = false;    ///< an island is driven against another that holds it fast
  double seconds = 0.0;    ///< since the frame before
  std::vector<SoundEvent> events;
  std::vector<VoxelChange> changes;
  std::array<float, kSoundGroups> volumes{1.0f, 1.0f, 1.0f, 1.0f};
};

/// What the mixer shall do.
struct AimVoice {
  VoiceId id = 0;
  VoiceAim aim;
};
struct StopVoice {
  VoiceId id = 0;
};
struct SetVolumes {
  std::array<float, kSoundGroups> volumes{};
};
using MixCommand = std::variant<VoiceStart, AimVoice, StopVoice, ReverbAim, SetVolumes>;
void apply(const MixCommand& command, Mixer& mixer);

class SoundScene {
 public:
  SoundScene() : paths_(keeper_.room()) {}

  std::vector<MixCommand> advance(const SoundFrame& frame);
  /// What became audible since the last call, such as "[splash to the left]".
  std::vector<std::string> take_captions() { return std::exchange(captions_, {}); }

 private:
  /// A sound that goes on.
  struct Source {
    VoiceId id = 0;
    Sound sound = Sound::kTorch;
    glm::dvec3 at{};  // in the room
    float gain = 1.0f;
  };
  void silence(std::vector<MixCommand>& out);
  void find_sources();
  void find_source(world::IVec3 cell, std::map<VoiceId, Source>& found) const;
  void hear_sources(const SoundFrame& frame, std::vector<MixCommand>& out);
  void hear_contacts(const SoundFrame& frame, std::vector<MixCommand>& out);
  void hear_wind(const SoundFrame& frame, std::vector<MixCommand>& out);
  void hear_event(const SoundFrame& frame, const SoundEvent& event, std::vector<MixCommand>& out);
  void hear_echo(std::vector<MixCommand>& out);
  void keep_voice(const Source& source, const VoiceAim& aim, std::vector<MixCommand>& out);
  VoiceAim aim_of(const SoundPath& path, float gain, double yaw_deg) const;
  void caption(Sound sound, const VoiceAim& aim, const SoundPath& path, double yaw_deg);

  RoomKeeper keeper_;
  SoundPaths paths_;
  RoomEcho echo_;
  glm::dvec3 ear_{};  // in the room
  std::vector<Source> sources_;
  std::uint64_t sources_revision_ = 0, echo_revision_ = 0;
  world::IVec3 echo_cell_;
  std::map<VoiceId, Sound> playing_;
  std::array<double, kSounds> captioned_s_{};  // when each was last; by clock_s_
  double clock_s_ = 0.0;
  std::uint32_t throws_ = 0;  // for variants
  std::optional<SetVolumes> volumes_;
  const world::World* world_ = nullptr;  // of the last frame
  std::vector<std::string> captions_;
};

}  // namespace skerry::game
