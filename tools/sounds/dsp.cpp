#include "tools/sounds/dsp.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "game/sound/sound_names.h"

namespace skerry::sounds {
namespace {

constexpr auto kRate = static_cast<float>(game::kSampleRate);
constexpr float kTurn = 2.0f * std::numbers::pi_v<float>;
constexpr float kMostPeak = 0.95f;

std::size_t samples_in(float seconds) {
  return static_cast<std::size_t>(std::max(0.0f, seconds) * kRate);
}

/// What an amplitude is multiplied by each sample to fall to 1/1000 in that time.
float decay_factor(float seconds) {
  return std::exp(-6.9078f / std::max(1.0f, seconds * kRate));
}

}  // namespace

float Noise::signed_unit() {
  // SplitMix64 (G. Steele, D. Lea and C. Flood, OOPSLA 2014).
  state_ += 0x9e3779b97f4a7c15u;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  const auto top = static_cast<std::int32_t>((z ^ (z >> 31)) >> 32);
  return static_cast<float>(top) * (1.0f / 2147483648.0f);
}

void BandPass::tune(float centre_hz, float q) {
  const float w = kTurn * std::clamp(centre_hz, 10.0f, 0.45f * kRate) / kRate;
  const float alpha = std::sin(w) / (2.0f * q);
  a_ = alpha / (1.0f + alpha);
  b1_ = -2.0f * std::cos(w) / (1.0f + alpha);
  b2_ = (1.0f - alpha) / (1.0f + alpha);
}

float BandPass::operator()(float x) {
  const float y = a_ * (x - x2_) - b1_ * y1_ - b2_ * y2_;
  x2_ = x1_;
  x1_ = x;
  y2_ = y1_;
  y1_ = y;
  return y;
}

LowPass::LowPass(float cutoff_hz) : k_(1.0f - std::exp(-kTurn * cutoff_hz / kRate)) {}

Clip silence(float seconds) {
  return Clip(samples_in(seconds), 0.0f);
}

void add_grain(Clip& clip, const Grain& grain, Noise& noise) {
  BandPass filter(grain.centre_hz, grain.q);
  const std::size_t begin = samples_in(grain.at_s);
  const std::size_t attack = std::max<std::size_t>(1, samples_in(grain.attack_s));
  const std::size_t end = std::min(clip.size(), begin + attack + samples_in(grain.decay_s));
  const float factor = decay_factor(grain.decay_s);
  // A narrow band passes less power; all grains of a level are about as loud.
  const float level = grain.level * std::sqrt(grain.q * 8000.0f / grain.centre_hz);
  float envelope = 1.0f;
  for (std::size_t i = begin; i < end; ++i) {
    const float rise = std::min(1.0f, static_cast<float>(i - begin) / static_cast<float>(attack));
    if (i - begin > attack) envelope *= factor;
    clip[i] += level * rise * envelope * filter(noise.signed_unit());
  }
}

void add_tone(Clip& clip, const Tone& tone) {
  const std::size_t begin = samples_in(tone.at_s), length = samples_in(tone.decay_s);
  const std::size_t end = std::min(clip.size(), begin + length);
  const float factor = decay_factor(tone.decay_s);
  float envelope = tone.level, phase = 0.0f;
  for (std::size_t i = begin; i < end; ++i) {
    const float part = static_cast<float>(i - begin) / static_cast<float>(length);
    phase += kTurn * (tone.from_hz + (tone.to_hz - tone.from_hz) * part) / kRate;
    if (phase > kTurn) phase -= kTurn;
    const float rise = std::min(1.0f, static_cast<float>(i - begin) / (0.001f * kRate));
    clip[i] += rise * envelope * std::sin(phase);
    envelope *= factor;
  }
}

void close_loop(Clip& clip, float overlap_s) {
  const std::size_t overlap = std::min(samples_in(overlap_s), clip.size() / 2);
  const std::size_t kept = clip.size() - overlap;
  for (std::size_t i = 0; i < overlap; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(overlap);
    clip[i] = clip[i] * std::sin(0.25f * kTurn * t) + clip[kept + i] * std::cos(0.25f * kTurn * t);
  }
  clip.resize(kept);
}

void fade_ends(Clip& clip, float in_s, float out_s) {
  const std::size_t in = std::min(samples_in(in_s), clip.size());
  const std::size_t out = std::min(samples_in(out_s), clip.size());
  for (std::size_t i = 0; i < in; ++i) clip[i] *= static_cast<float>(i) / static_cast<float>(in);
  for (std::size_t i = 0; i < out; ++i)
    clip[clip.size() - 1 - i] *= static_cast<float>(i) / static_cast<float>(out);
}

float loudest_rms(const Clip& clip, float window_s) {
  const std::size_t window = std::max<std::size_t>(1, std::min(samples_in(window_s), clip.size()));
  double sum = 0.0, most = 0.0;
  for (std::size_t i = 0; i < clip.size(); ++i) {
    sum += double{clip[i]} * clip[i];
    if (i >= window) sum -= double{clip[i - window]} * clip[i - window];
    most = std::max(most, sum);
  }
  return static_cast<float>(std::sqrt(most / static_cast<double>(window)));
}

void set_level(Clip& clip, float rms) {
  float peak = 0.0f;
  for (const float x : clip) peak = std::max(peak, std::abs(x));
  if (peak <= 0.0f) return;
  const float gain = std::min(rms / loudest_rms(clip, 0.05f), kMostPeak / peak);
  for (float& x : clip) x *= gain;
}

}  // namespace skerry::sounds
