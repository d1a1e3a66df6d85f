// Sounds that go on, and the list of all.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "game/sound/sound_bank.h"
#include "tools/sounds/sounds.h"

namespace skerry::sounds {
namespace {

using game::Sound;

constexpr float kOverlap = 0.5f;    // seconds, of the end of a loop with its beginning
constexpr std::size_t kSlice = 64;  // samples between which a moving filter stands still

/// A number that wanders slowly within -1 .. 1.
class Wander {
 public:
  Wander(float hz, Noise& noise) : smooth_(hz), again_(hz), noise_(noise) {
    // Narrow filters of noise are quiet: by about the root of the share of the band that they pass.
    scale_ = std::sqrt(static_cast<float>(game::kSampleRate) / kSlice / std::max(hz, 0.01f)) * 0.3f;
  }
  /// Once a slice.
  float next() {
    for (std::size_t i = 0; i < kSlice; ++i) value_ = again_(smooth_(noise_.signed_unit()));
    return std::clamp(value_ * scale_ * 8.0f, -1.0f, 1.0f);
  }

 private:
  LowPass smooth_, again_;
  Noise& noise_;
  float value_ = 0.0f, scale_ = 1.0f;
};

/// Noise in a band that wanders about a centre, by up to `octaves` each way.
void add_band(Clip& clip, float centre_hz, float q, float octaves, Noise& noise) {
  Wander pitch(0.7f, noise), strength(0.9f, noise);
  BandPass filter(centre_hz, q);
  const float level = std::sqrt(q * 8000.0f / centre_hz);
  for (std::size_t i = 0; i < clip.size(); i += kSlice) {
    filter.tune(centre_hz * std::exp2(octaves * pitch.next()), q);
    const float gust = level * (0.7f + 0.3f * strength.next());
    for (std::size_t k = i; k < std::min(i + kSlice, clip.size()); ++k)
      clip[k] += gust * filter(noise.signed_unit());
  }
}

Clip finished_loop(Clip clip) {
  // No rumble below what is heard, which would only eat the range.
  LowPass below(25.0f);
  for (float& x : clip) x -= below(x);
  close_loop(clip, kOverlap);
  set_level(clip, kLoopRms);
  return clip;
}

}  // namespace

Clip make_wind(std::uint64_t seed) {
  Noise noise(seed);
  Clip clip = silence(6.0f + kOverlap);
  add_band(clip, 320.0f, 0.7f, 0.6f, noise);
  LowPass soft(500.0f);
  Clip whistle = silence(6.0f + kOverlap);
  add_band(whistle, 900.0f, 4.0f, 0.5f, noise);
  for (std::size_t i = 0; i < clip.size(); ++i) clip[i] = soft(clip[i]) + 0.15f * whistle[i];
  return finished_loop(std::move(clip));
}

Clip make_torch(std::uint64_t seed) {
  Noise noise(seed);
  Clip clip = silence(4.0f + kOverlap);
  add_band(clip, 240.0f, 0.6f, 0.4f, noise);
  for (int i = 0; i < 150; ++i) {
    const float strength = noise.unit();
    add_grain(clip,
              {noise.between(0.0f, 4.4f), 0.0005f, noise.between(0.004f, 0.02f),
               noise.between(1500.0f, 5500.0f), 1.5f, 0.3f + 2.2f * strength * strength * strength},
              noise);
  }
  return finished_loop(std::move(clip));
}

Clip make_lava(std::uint64_t seed) {
  Noise noise(seed);
  Clip clip = silence(5.0f + kOverlap);
  add_band(clip, 90.0f, 0.8f, 0.3f, noise);
  for (float& x : clip) x *= 0.2f;
  for (int i = 0; i < 45; ++i) {
    const float hz = noise.between(70.0f, 190.0f);
    add_tone(clip, {noise.between(0.0f, 5.3f), noise.between(0.08f, 0.22f), hz,
                    hz * noise.between(1.4f, 2.2f), noise.between(0.4f, 1.4f)});
  }
  return finished_loop(std::move(clip));
}

Clip make_water(std::uint64_t seed) {
  Noise noise(seed);
  Clip clip = silence(4.0f + kOverlap);
  add_band(clip, 1100.0f, 0.5f, 0.3f, noise);
  for (float& x : clip) x *= 0.35f;
  for (int i = 0; i < 420; ++i) {
    const float hz = noise.between(400.0f, 2200.0f);
    add_tone(clip, {noise.between(0.0f, 4.4f), noise.between(0.01f, 0.06f), hz,
                    hz * noise.between(1.05f, 1.4f), noise.between(0.1f, 0.7f)});
  }
  return finished_loop(std::move(clip));
}

Clip make_grind(std::uint64_t seed) {
  Noise noise(seed);
  Clip clip = silence(4.0f + kOverlap);
  add_band(clip, 85.0f, 0.7f, 0.4f, noise);
  // Rock that sticks and slips.
  for (float at = 0.0f; at < 4.4f; at += noise.between(0.03f, 0.12f)) {
    add_grain(clip,
              {at, 0.004f, noise.between(0.05f, 0.25f), noise.between(120.0f, 520.0f), 1.2f,
               noise.between(0.3f, 1.2f)},
              noise);
  }
  LowPass dull(450.0f);
  for (float& x : clip) x = dull(x);
  return finished_loop(std::move(clip));
}

Clip make_sound(std::size_t clip, std::uint64_t seed) {
  // Which kind, and which of it.
  std::size_t kind = 0, within = clip;
  while (within >= game::clips_of(game::kSoundKinds[kind]))
    within -= game::clips_of(game::kSoundKinds[kind++]);
  const auto material = static_cast<game::SoundMaterial>(
      within / static_cast<std::size_t>(game::kSoundKinds[kind].variants));
  const std::uint64_t own = seed * 1000003u + clip;
  switch (static_cast<Sound>(kind)) {
    case Sound::kStep:
      return make_step(material, own);
    case Sound::kDig:
      return make_dig(material, own);
    case Sound::kPlace:
      return make_place(material, own);
    case Sound::kSplash:
      return make_splash(own);
    case Sound::kClick:
      return make_click(own);
    case Sound::kWind:
      return make_wind(own);
    case Sound::kTorch:
      return make_torch(own);
    case Sound::kLava:
      return make_lava(own);
    case Sound::kWater:
      return make_water(own);
    default:
      return make_grind(own);
  }
}

std::vector<Clip> make_sounds(std::uint64_t seed) {
  std::vector<Clip> clips;
  for (std::size_t i = 0; i < game::kClips; ++i) clips.push_back(make_sound(i, seed));
  return clips;
}

std::vector<std::uint8_t> encode(const std::vector<Clip>& clips) {
  std::vector<std::uint8_t> bytes;
  const auto put = [&bytes](std::uint32_t word, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
  };
  for (const std::uint32_t word :
       {game::kSoundBankMagic, game::kSoundBankVersion, static_cast<std::uint32_t>(clips.size())})
    put(word, 4);
  for (const Clip& clip : clips) put(static_cast<std::uint32_t>(clip.size()), 4);
  for (const Clip& clip : clips)
    for (const float x : clip)
      put(static_cast<std::uint32_t>(std::lround(std::clamp(x, -1.0f, 1.0f) * 32767.0f)), 2);
  return bytes;
}

}  // namespace skerry::sounds
