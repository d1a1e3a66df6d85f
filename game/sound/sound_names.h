// Which sounds there are, and in which order the bank holds them.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace skerry::game {

/// Samples a second of every clip and of what is mixed.
inline constexpr int kSampleRate = 48000;

/// What is stepped on, dug or placed, as it sounds.
enum class SoundMaterial : std::uint8_t {
  kStone,
  kSoil,
  kSand,
  kWood,
  kLeaves,
  kSnow,
  kWater,
  kCount
};
inline constexpr std::size_t kSoundMaterials = static_cast<std::size_t>(SoundMaterial::kCount);
inline constexpr std::array<std::string_view, kSoundMaterials> kSoundMaterialNames{
    "stone", "soil", "sand", "wood", "leaves", "snow", "water"};

/// Kinds of sound. The first three have a clip a material, all may have variants.
enum class Sound : std::uint8_t {
  kStep,
  kDig,
  kPlace,
  kSplash,
  kClick,
  kWind,  ///< loops from here on
  kTorch,
  kLava,
  kWater,
  kGrind,
  kCount
};
inline constexpr std::size_t kSounds = static_cast<std::size_t>(Sound::kCount);

/// A kind of sound in the bank.
struct SoundKind {
  std::string_view name;
  int variants = 1;
  bool by_material = false;
  bool loops = false;
};
inline constexpr std::array<SoundKind, kSounds> kSoundKinds{{{"step", 3, true, false},
                                                             {"dig", 2, true, false},
                                                             {"place", 1, true, false},
                                                             {"splash", 2, false, false},
                                                             {"click", 1, false, false},
                                                             {"wind", 1, false, true},
                                                             {"torch", 1, false, true},
                                                             {"lava", 1, false, true},
                                                             {"water", 1, false, true},
                                                             {"grind", 1, false, true}}};

constexpr const SoundKind& sound_kind(Sound sound) {
  return kSoundKinds[static_cast<std::size_t>(sound)];
}
constexpr std::size_t clips_of(const SoundKind& kind) {
  return static_cast<std::size_t>(kind.variants) * (kind.by_material ? kSoundMaterials : 1);
}

/// The clip of a sound in the bank: kinds in order, in each the materials, in each the variants.
/// @param variant any number; taken modulo how many there are.
constexpr std::size_t clip_index(Sound sound, SoundMaterial material = SoundMaterial::kStone,
                                 std::uint32_t variant = 0) {
  std::size_t index = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(sound); ++i)
    index += clips_of(kSoundKinds[i]);
  const SoundKind& kind = sound_kind(sound);
  const auto variants = static_cast<std::size_t>(kind.variants);
  if (kind.by_material) index += static_cast<std::size_t>(material) * variants;
  return index + variant % variants;
}
inline constexpr std::size_t kClips = clip_index(Sound::kGrind) + clips_of(kSoundKinds.back());

}  // namespace skerry::game
