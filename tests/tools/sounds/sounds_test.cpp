#include "tools/sounds/sounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include "game/sound/sound_bank.h"
#include "tests/game/sound/listen.h"

namespace skerry::sounds {
namespace {

using game::clip_index;
using game::Sound;
using game::SoundMaterial;

const std::vector<Clip>& clips() {
  static const std::vector<Clip> all = make_sounds(1);
  return all;
}

bool is_loop(std::size_t clip) {
  return clip >= clip_index(Sound::kWind);
}

/// Loudest 50 ms, by the definition.
double loudest(const Clip& clip) {
  constexpr std::size_t kWindow = 2400;
  double most = 0.0;
  for (std::size_t i = 0; i + kWindow <= clip.size(); i += 48)
    most = std::max(most, rms_of(std::span(clip).subspan(i, kWindow)));
  return most;
}

TEST(Sounds, AreAllAsLoudAsIsStated) {
  ASSERT_EQ(clips().size(), game::kClips);
  for (std::size_t i = 0; i < clips().size(); ++i) {
    SCOPED_TRACE(i);
    for (const float x : clips()[i]) ASSERT_TRUE(std::isfinite(x));
    EXPECT_LE(peak_of(clips()[i]), 0.9501);
    const double level = decibels(loudest(clips()[i]));
    EXPECT_GE(level, is_loop(i) ? -25.0 : -22.0);
    EXPECT_LE(level, is_loop(i) ? -17.9 : -13.5);
  }
}

TEST(Sounds, ShortOnesBeginAndEndInSilence) {
  for (std::size_t i = 0; i < clips().size(); ++i) {
    if (is_loop(i)) continue;
    SCOPED_TRACE(i);
    EXPECT_LT(std::abs(clips()[i].front()), 1e-3);
    EXPECT_LT(std::abs(clips()[i].back()), 1e-4);
    EXPECT_LT(decibels(rms_of(std::span(clips()[i]).last(480))), -50.0);
  }
}

TEST(Sounds, LoopsCloseWithoutAClick) {
  for (std::size_t i = clip_index(Sound::kWind); i < clips().size(); ++i) {
    SCOPED_TRACE(i);
    const Clip& clip = clips()[i];
    EXPECT_GE(clip.size(), 3u * game::kSampleRate);
    // Bends from the end to the beginning are none that stand out of the 50 ms around.
    constexpr std::size_t kAround = 2400;
    std::vector<float> seam(clip.end() - kAround, clip.end());
    seam.insert(seam.end(), clip.begin(), clip.begin() + kAround);
    double usual = 0.0, at_seam = 0.0;
    for (std::size_t k = 1; k + 1 < seam.size(); ++k) {
      const double bend = std::abs(seam[k - 1] - 2.0 * seam[k] + seam[k + 1]);
      double& most = k == kAround - 1 || k == kAround ? at_seam : usual;
      most = std::max(most, bend);
    }
    EXPECT_LE(at_seam, usual);
    // Nor does the level break off there.
    const double begin = rms_of(std::span(clip).first(12000));
    const double end = rms_of(std::span(clip).last(12000));
    EXPECT_LT(std::abs(decibels(begin) - decibels(end)), 7.0);
  }
}

TEST(Sounds, MaterialsAreOrderedByBrightness) {
  // Mean of the variants: each is another throw of the dice.
  const auto of = [](Sound sound, SoundMaterial material) {
    const int variants = game::sound_kind(sound).variants;
    double sum = 0.0;
    for (int v = 0; v < variants; ++v)
      sum += centroid_hz(clips()[clip_index(sound, material, static_cast<std::uint32_t>(v))]);
    return sum / variants;
  };
  for (const Sound sound : {Sound::kStep, Sound::kDig, Sound::kPlace}) {
    SCOPED_TRACE(game::sound_kind(sound).name);
    const double wood = of(sound, SoundMaterial::kWood), soil = of(sound, SoundMaterial::kSoil),
                 snow = of(sound, SoundMaterial::kSnow), stone = of(sound, SoundMaterial::kStone),
                 sand = of(sound, SoundMaterial::kSand), leaves = of(sound, SoundMaterial::kLeaves),
                 water = of(sound, SoundMaterial::kWater);
    RecordProperty("wood_hz", std::to_string(wood));
    EXPECT_LT(wood, soil);
    EXPECT_LT(soil, snow);
    EXPECT_LT(water, snow);
    EXPECT_LT(snow, stone);
    EXPECT_LT(stone, sand);
    EXPECT_LT(sand, leaves);
  }
}

TEST(Sounds, LoopsLieWhereTheirSourcesDo) {
  const auto of = [](Sound sound) { return centroid_hz(clips()[clip_index(sound)]); };
  EXPECT_LT(of(Sound::kLava), 300.0);
  EXPECT_LT(of(Sound::kGrind), 400.0);
  EXPECT_GT(of(Sound::kWind), of(Sound::kGrind));
  EXPECT_LT(of(Sound::kWind), 800.0);
  EXPECT_GT(of(Sound::kWater), 700.0);
  EXPECT_GT(of(Sound::kTorch), of(Sound::kLava));
}

TEST(Sounds, VariantsDiffer) {
  for (std::uint32_t v = 1; v < 3; ++v)
    EXPECT_NE(clips()[clip_index(Sound::kStep, SoundMaterial::kSoil, 0)],
              clips()[clip_index(Sound::kStep, SoundMaterial::kSoil, v)]);
}

TEST(Sounds, AreTheSameBytesOnAnyThreadInAnyOrder) {
  std::vector<Clip> made(game::kClips);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 3; ++t)
    threads.emplace_back([&made, t] {
      for (std::size_t i = game::kClips; i-- > 0;)
        if (i % 3 == t) made[i] = make_sound(i, 1);
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(encode(made), encode(clips()));
  EXPECT_NE(encode(make_sounds(2)), encode(clips()));
}

TEST(SoundBank, HoldsWhatWasSynthesised) {
  const game::SoundBank& bank = game::sound_bank();
  for (std::size_t i = 0; i < game::kClips; ++i) {
    ASSERT_EQ(bank.clips[i].size(), clips()[i].size());
    for (std::size_t k = 0; k < clips()[i].size(); k += 97)
      ASSERT_EQ(bank.clips[i][k], std::lround(clips()[i][k] * 32767.0f));
  }
}

TEST(SoundBank, RefusesWhatIsCutOrLiesAboutItsLengths) {
  const std::vector<std::uint8_t> whole = encode(clips());
  const auto read = [](const std::vector<std::uint8_t>& bytes) {
    return static_cast<bool>(game::parse_sound_bank(std::as_bytes(std::span(bytes))));
  };
  EXPECT_TRUE(read(whole));
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{11}, std::size_t{100}, whole.size() - 2, whole.size() - 1})
    EXPECT_FALSE(read({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)})) << size;
  for (std::size_t at = 0; at < 12 + 4 * game::kClips; ++at) {
    std::vector<std::uint8_t> bent = whole;
    bent[at] ^= 0x81;
    EXPECT_FALSE(read(bent)) << at;
  }
}

TEST(SoundNames, GiveEachClipAnIndexOfItsOwn) {
  std::vector<int> seen(game::kClips, 0);
  for (std::size_t s = 0; s < game::kSounds; ++s) {
    const auto sound = static_cast<Sound>(s);
    const game::SoundKind& kind = game::sound_kind(sound);
    for (std::size_t m = 0; m < (kind.by_material ? game::kSoundMaterials : 1); ++m)
      for (int v = 0; v < kind.variants; ++v)
        ++seen[clip_index(sound, static_cast<SoundMaterial>(m), static_cast<std::uint32_t>(v))];
  }
  EXPECT_EQ(seen, std::vector<int>(game::kClips, 1));
}

}  // namespace
}  // namespace skerry::sounds
