#include "game/sound/sound_bank.h"

#include <bit>

#include "engine/core/check.h"
#include "engine/core/words.h"

// Begin and end of the file, placed in the program by cmake/sounds.cmake.
extern "C" {
extern const std::byte skerry_sound_bank[], skerry_sound_bank_end[];
}

namespace skerry::game {
namespace {

static_assert(std::endian::native == std::endian::little, "samples are used where they lie");

}  // namespace

Result<SoundBank> parse_sound_bank(std::span<const std::byte> file) {
  constexpr std::size_t kCountsEnd = kSoundBankHeaderBytes + kClips * 4;
  if (file.size() < kCountsEnd || word_at(file, 0) != kSoundBankMagic ||
      word_at(file, 1) != kSoundBankVersion || word_at(file, 2) != kClips)
    return Error{
        "cannot read the sounds: not a sound bank of this version; build it with skerry_sounds"};
  SoundBank bank;
  std::size_t at = kCountsEnd;
  for (std::size_t i = 0; i < kClips; ++i) {
    const std::uint32_t samples = word_at(file, 3 + i);
    if (samples == 0 || samples > kMaxClipSamples || samples * 2 > file.size() - at)
      return Error{"cannot read the sounds: impossible length of a clip; build the file again"};
    bank.clips[i] = {reinterpret_cast<const std::int16_t*>(file.data() + at), samples};
    at += std::size_t{samples} * 2;
  }
  if (at != file.size())
    return Error{"cannot read the sounds: the file is too long; build it again"};
  return bank;
}

const SoundBank& sound_bank() {
  static const SoundBank bank = [] {
    const auto parsed = parse_sound_bank({skerry_sound_bank, skerry_sound_bank_end});
    SKERRY_ASSERT(parsed);
    return *parsed;
  }();
  return bank;
}

}  // namespace skerry::game
