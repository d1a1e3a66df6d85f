// All clips: synthesised while the program was built (tools/sounds) and held by it.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/core/result.h"
#include "game/sound/sound_names.h"

namespace skerry::game {

/// The file: magic, version and number of clips, then the samples of each clip as a count, all
/// 32 bits; then the samples, clip after clip, 16 bits, signed. Little-endian.
inline constexpr std::uint32_t kSoundBankMagic = 0x444e5353;  // "SSND"
inline constexpr std::uint32_t kSoundBankVersion = 1;
inline constexpr std::size_t kSoundBankHeaderBytes = 12;
/// No clip is longer.
inline constexpr std::uint32_t kMaxClipSamples = 60u * kSampleRate;

/// Mono clips at kSampleRate, by clip_index.
struct SoundBank {
  std::array<std::span<const std::int16_t>, kClips> clips;
};

/// @param file outlives the bank; aligned to 2 bytes. Errors: it is no bank of this version, or cut
/// short.
Result<SoundBank> parse_sound_bank(std::span<const std::byte> file);

/// What the program holds.
const SoundBank& sound_bank();

}  // namespace skerry::game
