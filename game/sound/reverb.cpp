#include "game/sound/reverb.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "game/sound/sound_names.h"

namespace skerry::game {
namespace {

constexpr auto kTailRate = static_cast<float>(kSampleRate);
// Lengths without common factors, 24 to 68 ms, so that echoes do not fall together.
constexpr std::size_t kLengths[] = {1153, 1361, 1601, 1867, 2143, 2447, 2789, 3251};
constexpr float kInaudible = 1e-6f;        // -120 dB
constexpr float kTailGlide = 1.0f / 2400;  // of the way to the goal, each sample: 50 ms

/// Sums and differences of all, eight at once, scaled to keep the power.
void hadamard(std::array<float, 8>& x) {
  for (std::size_t half = 1; half < 8; half *= 2)
    for (std::size_t i = 0; i < 8; i += 2 * half)
      for (std::size_t k = i; k < i + half; ++k) {
        const float a = x[k], b = x[k + half];
        x[k] = a + b;
        x[k + half] = a - b;
      }
  for (float& v : x) v *= 0.35355339f;
}

}  // namespace

Reverb::Reverb() {
  for (std::size_t i = 0; i < kLines; ++i) lines_[i].delay.assign(kLengths[i], 0.0f);
  set({});
  for (Line& line : lines_) line.feedback = line.goal;
  quiet_ = kLengths[kLines - 1];
}

void Reverb::set(const ReverbAim& aim) {
  const float decay_s = std::clamp(aim.decay_s, 0.1f, 8.0f);
  for (Line& line : lines_)
    line.goal =
        std::pow(10.0f, -3.0f * static_cast<float>(line.delay.size()) / (decay_s * kTailRate));
  level_goal_ = std::clamp(aim.level, 0.0f, 1.0f);
  const float cutoff = std::clamp(aim.damping_hz, 200.0f, 20000.0f);
  pole_ = 1.0f - std::exp(-2.0f * std::numbers::pi_v<float> * cutoff / kTailRate);
}

void Reverb::render(std::span<const float> send, std::span<float> left, std::span<float> right) {
  bool heard = false;
  for (const float x : send) heard |= std::abs(x) > kInaudible;
  // A tail that has died away costs nothing.
  if (!heard && quiet_ >= kLengths[kLines - 1]) {
    level_ = level_goal_;
    for (Line& line : lines_) line.feedback = line.goal;
    return;
  }
  float loudest = 0.0f;
  for (std::size_t i = 0; i < send.size(); ++i) {
    std::array<float, kLines> out;
    for (std::size_t k = 0; k < kLines; ++k) {
      Line& line = lines_[k];
      line.low += pole_ * (line.delay[line.at] - line.low);
      line.feedback += kTailGlide * (line.goal - line.feedback);
      out[k] = line.feedback * line.low;
    }
    level_ += kTailGlide * (level_goal_ - level_);
    const float wet_left = out[0] + out[2] + out[4] + out[6];
    const float wet_right = out[1] + out[3] + out[5] + out[7];
    loudest = std::max(loudest, std::abs(wet_left) + std::abs(wet_right));
    left[i] += level_ * wet_left;
    right[i] += level_ * wet_right;
    hadamard(out);
    for (std::size_t k = 0; k < kLines; ++k) {
      Line& line = lines_[k];
      line.delay[line.at] = out[k] + 0.5f * send[i];
      if (++line.at == line.delay.size()) line.at = 0;
    }
  }
  quiet_ = heard || loudest > kInaudible ? 0 : quiet_ + send.size();
}

}  // namespace skerry::game
