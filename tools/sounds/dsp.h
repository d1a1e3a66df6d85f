// What sounds are made of: noise, filters, grains and bubbles. Plain code on one thread.
#pragma once
#include <cstdint>
#include <vector>

namespace skerry::sounds {

/// Samples of one channel, about -1 .. 1, at game::kSampleRate.
using Clip = std::vector<float>;

/// White noise and random numbers from a seed.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 0x632be59bd9b4e019u) {}
  float signed_unit();                                    ///< -1 .. 1
  float unit() { return 0.5f * (signed_unit() + 1.0f); }  ///< 0 .. 1
  float between(float low, float high) { return low + (high - low) * unit(); }

 private:
  std::uint64_t state_;
};

/// A band-pass of unit gain in the middle (R. Bristow-Johnson, Cookbook formulae for audio EQ
/// biquad filter coefficients, 1994).
class BandPass {
 public:
  BandPass(float centre_hz, float q) { tune(centre_hz, q); }
  void tune(float centre_hz, float q);  ///< keeps what it remembers
  float operator()(float x);

 private:
  float a_ = 0.0f, b1_ = 0.0f, b2_ = 0.0f;
  float x1_ = 0.0f, x2_ = 0.0f, y1_ = 0.0f, y2_ = 0.0f;
};

/// One pole, -3 dB at the cut-off.
class LowPass {
 public:
  explicit LowPass(float cutoff_hz);
  float operator()(float x) { return y_ += k_ * (x - y_); }

 private:
  float k_, y_ = 0.0f;
};

Clip silence(float seconds);

/// A burst of band-passed noise that rises in `attack_s` and falls to 1/1000 in `decay_s`.
struct Grain {
  float at_s = 0.0f, attack_s = 0.001f, decay_s = 0.05f;
  float centre_hz = 1000.0f, q = 1.0f, level = 1.0f;
};
void add_grain(Clip& clip, const Grain& grain, Noise& noise);

/// A tone that falls to 1/1000 in `decay_s` and glides to another pitch meanwhile: a resonance of
/// something struck, or a bubble that rises.
struct Tone {
  float at_s = 0.0f, decay_s = 0.1f;
  float from_hz = 200.0f, to_hz = 200.0f, level = 1.0f;
};
void add_tone(Clip& clip, const Tone& tone);

/// Makes the end run into the beginning: the last `overlap_s` is cut off and blended into the
/// first, at equal power.
void close_loop(Clip& clip, float overlap_s);
/// Begins and ends at zero, within so many seconds.
void fade_ends(Clip& clip, float in_s, float out_s);
/// RMS of the loudest stretch of `window_s` [1 is full scale].
float loudest_rms(const Clip& clip, float window_s);
/// Scales to that RMS in the loudest 50 ms, but no peak beyond 0.95.
void set_level(Clip& clip, float rms);

}  // namespace skerry::sounds
