// Mixes clips to stereo: plain numbers in, samples out, on whatever thread calls it. No device.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "game/sound/reverb.h"
#include "game/sound/sound_bank.h"
#include "game/sound/sound_names.h"

namespace skerry::game {

inline constexpr std::size_t kMaxVoices = 64;

/// What a player sets the loudness of. kMaster scales the others.
enum class SoundGroup : std::uint8_t { kMaster, kEffects, kAmbience, kInterface, kCount };
inline constexpr std::size_t kSoundGroups = static_cast<std::size_t>(SoundGroup::kCount);

/// How a voice reaches the ears. Voices glide from one to the next within kGlideSeconds.
struct VoiceAim {
  float gain = 1.0f;           ///< amplitude, 0 .. 4
  float pan = 0.0f;            ///< -1 left .. 1 right, at equal power
  float cutoff_hz = 20000.0f;  ///< of its low-pass; from 18000 on there is none
  float reverb = 0.0f;         ///< amplitude that the reverb gets, 0 .. 4
};
inline constexpr double kGlideSeconds = 0.02;

/// Names a voice of whoever starts it. 0 is no one's.
using VoiceId = std::uint64_t;

struct VoiceStart {
  VoiceId id = 0;        ///< a voice of this id that plays is replaced; 0: it cannot be named later
  std::size_t clip = 0;  ///< of the bank
  bool loops = false;
  float speed = 1.0f;  ///< of the clip, 0.25 .. 4: pitch
  SoundGroup group = SoundGroup::kEffects;
  VoiceAim aim;
};

class Mixer {
 public:
  /// @param bank outlives this.
  explicit Mixer(const SoundBank& bank);

  /// When all voices are taken, the quietest gives way, or the new one if it is quieter.
  void start(const VoiceStart& voice);
  /// No effect if no such voice plays.
  void aim(VoiceId id, const VoiceAim& aim);
  /// Fades out within kGlideSeconds.
  void stop(VoiceId id);
  void stop_all();
  /// @param volume 0 .. 1.
  void set_volume(SoundGroup group, float volume);
  void set_reverb(const ReverbAim& aim) { reverb_.set(aim); }

  /// The next samples, left and right in turn; replaces `stereo`, whose size is even. Beyond 0.8 of
  /// full scale loudness is compressed; nothing leaves -1 .. 1.
  void render(std::span<float> stereo);

  std::size_t voices() const;  ///< that play now

 private:
  struct Voice {
    VoiceStart start;
    bool playing = false, ending = false;
    double at = 0.0;  // in the clip [samples]
    // Now; after `aim` and volume, which they glide to.
    float left = 0.0f, right = 0.0f, reverb = 0.0f, pole = 1.0f;
    float low = 0.0f;  // what the low-pass remembers
  };
  /// Where a voice's gains go: per channel.
  struct Goal {
    float left, right, reverb, pole;
  };
  static constexpr std::size_t kBlock = 128;  // samples that are mixed at a time
  /// Voices that are mixed at a time: a low-pass waits for its own last sample, so that four take
  /// no longer than one.
  static constexpr std::size_t kTogether = 4;
  using Clip = std::array<float, kBlock>;

  Goal goal_of(const Voice& voice) const;
  Voice* find(VoiceId id);
  Voice* free_voice(float gain);
  void fill(Voice& voice, std::size_t samples, Clip& clip);
  static void low_pass(std::span<Voice* const> voices, std::span<Clip> clips, std::size_t samples);
  void add(Voice& voice, const Goal& goal, std::size_t samples, const Clip& clip);
  void mix_voices(std::span<Voice* const> voices, std::size_t samples);
  void mix_block(std::span<float> stereo);

  const SoundBank& bank_;
  std::array<Voice, kMaxVoices> voices_;
  std::array<float, kSoundGroups> volumes_;
  float master_ = 1.0f;  // glides to its volume
  Reverb reverb_;
  std::array<Clip, kTogether> clips_{};
  Clip left_{}, right_{}, send_{};
};

}  // namespace skerry::game
