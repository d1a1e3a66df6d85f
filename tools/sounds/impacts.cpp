// Short sounds: something struck, stepped on or fallen into.
#include <array>

#include "tools/sounds/sounds.h"

namespace skerry::sounds {
namespace {

using game::SoundMaterial;

/// How a material answers a blow: a scatter of grains, and what rings below them.
struct Recipe {
  float centre_hz, q;  ///< of its grains
  int grains;
  float spread_s, decay_s;  ///< over how long they lie, and how fast each fades
  float attack_s;
  float thump_hz, thump;         ///< the body below, and its level
  std::array<float, 3> ring_hz;  ///< resonances; 0: none
  float ring_s, ring;            ///< how long they last, and their level
};

constexpr std::array<Recipe, game::kSoundMaterials> kRecipes{{
    {3600.0f, 0.9f, 7, 0.03f, 0.05f, 0.001f, 160.0f, 0.14f, {1900, 3300, 5100}, 0.05f, 0.45f},
    {420.0f, 1.3f, 9, 0.07f, 0.07f, 0.004f, 95.0f, 0.30f, {0, 0, 0}, 0.0f, 0.0f},
    {4600.0f, 0.6f, 50, 0.16f, 0.05f, 0.006f, 90.0f, 0.06f, {0, 0, 0}, 0.0f, 0.0f},
    {430.0f, 1.8f, 3, 0.02f, 0.06f, 0.001f, 120.0f, 0.45f, {210, 395, 690}, 0.11f, 0.60f},
    {6600.0f, 0.9f, 34, 0.20f, 0.03f, 0.003f, 110.0f, 0.02f, {0, 0, 0}, 0.0f, 0.0f},
    {1500.0f, 2.2f, 60, 0.18f, 0.025f, 0.002f, 100.0f, 0.10f, {0, 0, 0}, 0.0f, 0.0f},
    {700.0f, 1.3f, 8, 0.14f, 0.10f, 0.010f, 110.0f, 0.15f, {0, 0, 0}, 0.0f, 0.0f},
}};

/// Bubbles that close under a surface: short tones that rise (after K. van den Doel, Physically
/// Based Models for Liquid Sounds, ACM TAP 2005).
void add_bubbles(Clip& clip, int count, float from_s, float to_s, Noise& noise) {
  for (int i = 0; i < count; ++i) {
    const float hz = noise.between(350.0f, 1600.0f);
    add_tone(clip, {noise.between(from_s, to_s), noise.between(0.03f, 0.09f), hz,
                    hz * noise.between(1.1f, 1.7f), noise.between(0.15f, 0.5f)});
  }
}

/// @param weight of the blow: 1 a step; more is longer, lower and louder below.
Clip strike(SoundMaterial material, float seconds, float weight, Noise& noise) {
  const Recipe& recipe = kRecipes[static_cast<std::size_t>(material)];
  Clip clip = silence(seconds);
  for (int i = 0; i < recipe.grains; ++i) {
    const float late = noise.unit() * noise.unit();  // most of them early
    add_grain(clip,
              {late * recipe.spread_s * weight, recipe.attack_s, recipe.decay_s * weight,
               recipe.centre_hz * noise.between(0.75f, 1.3f) / weight, recipe.q,
               noise.between(0.4f, 1.0f)},
              noise);
  }
  const float hz = recipe.thump_hz * noise.between(0.9f, 1.1f) / weight;
  add_tone(clip, {0.0f, 0.12f * weight, hz, 0.7f * hz, 2.0f * recipe.thump * weight});
  for (const float ring_hz : recipe.ring_hz) {
    if (ring_hz == 0.0f) continue;
    const float tuned = ring_hz * noise.between(0.94f, 1.06f) / weight;
    add_tone(clip, {0.0f, recipe.ring_s * noise.between(0.8f, 1.2f) * weight, tuned, tuned,
                    recipe.ring * noise.between(0.6f, 1.0f)});
  }
  if (material == SoundMaterial::kWater) add_bubbles(clip, 7, 0.02f, 0.6f * seconds, noise);
  return clip;
}

Clip finished_impact(Clip clip, float rms) {
  fade_ends(clip, 0.001f, 0.03f);
  set_level(clip, rms);
  return clip;
}

}  // namespace

Clip make_step(SoundMaterial material, std::uint64_t seed) {
  Noise noise(seed);
  return finished_impact(strike(material, 0.3f, 1.0f, noise), kShortRms);
}

Clip make_dig(SoundMaterial material, std::uint64_t seed) {
  Noise noise(seed);
  Clip clip = strike(material, 0.35f, 1.25f, noise);
  // What comes loose.
  const Recipe& recipe = kRecipes[static_cast<std::size_t>(material)];
  for (int i = 0; i < 6; ++i)
    add_grain(clip,
              {noise.between(0.05f, 0.2f), 0.001f, 0.03f,
               recipe.centre_hz * noise.between(0.8f, 1.2f), recipe.q, noise.between(0.1f, 0.35f)},
              noise);
  return finished_impact(std::move(clip), kShortRms);
}

Clip make_place(SoundMaterial material, std::uint64_t seed) {
  Noise noise(seed);
  return finished_impact(strike(material, 0.28f, 1.4f, noise), kShortRms);
}

Clip make_splash(std::uint64_t seed) {
  Noise noise(seed);
  Clip clip = silence(1.0f);
  for (int i = 0; i < 24; ++i) {
    const float at = 0.35f * noise.unit() * noise.unit();
    add_grain(clip,
              {at, 0.008f, noise.between(0.15f, 0.45f), noise.between(500.0f, 2600.0f), 0.7f,
               noise.between(0.3f, 0.8f) * (1.0f - at)},
              noise);
  }
  add_tone(clip, {0.0f, 0.2f, 140.0f, 80.0f, 1.5f});
  add_bubbles(clip, 30, 0.08f, 0.8f, noise);
  return finished_impact(std::move(clip), kShortRms);
}

Clip make_click(std::uint64_t seed) {
  Noise noise(seed);
  Clip clip = silence(0.06f);
  add_grain(clip, {0.0f, 0.001f, 0.012f, 3200.0f, 2.0f, 0.5f}, noise);
  add_tone(clip, {0.0f, 0.05f, 1150.0f, 1000.0f, 0.8f});
  return finished_impact(std::move(clip), kShortRms);
}

}  // namespace skerry::sounds
