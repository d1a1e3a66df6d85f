#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "game/sound/sound_names.h"
#include "tools/sounds/dsp.h"

namespace skerry::sounds {

/// RMS of the loudest 50 ms [1 is full scale] that clips are made to have: short ones may be
/// quieter, because their peaks end at 0.95.
inline constexpr float kShortRms = 0.2f, kLoopRms = 0.12f;

// impacts.cpp: one function a kind of short sound.
Clip make_step(game::SoundMaterial material, std::uint64_t seed);
Clip make_dig(game::SoundMaterial material, std::uint64_t seed);
Clip make_place(game::SoundMaterial material, std::uint64_t seed);
Clip make_splash(std::uint64_t seed);
Clip make_click(std::uint64_t seed);

// loops.cpp: their ends run into their beginnings.
Clip make_wind(std::uint64_t seed);
Clip make_torch(std::uint64_t seed);
Clip make_lava(std::uint64_t seed);
Clip make_water(std::uint64_t seed);
Clip make_grind(std::uint64_t seed);

/// All clips in the order of game::clip_index. Each depends on the seed and its place alone, so on
/// no other and on no thread.
std::vector<Clip> make_sounds(std::uint64_t seed);
/// One of them.
Clip make_sound(std::size_t clip, std::uint64_t seed);

/// The file that the program holds (game/sound/sound_bank.h).
std::vector<std::uint8_t> encode(const std::vector<Clip>& clips);

}  // namespace skerry::sounds
