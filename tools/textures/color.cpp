#include "tools/textures/color.h"

#include <algorithm>
#include <cmath>

namespace skerry::textures {
namespace {

// x^2.4 = x^2 * (x^(1/5))^2. Newton's method from above converges in well under 32 steps for x >
// 0.04.
double power_2_4(double x) {
  double root = 1.0;
  for (int i = 0; i < 32; ++i) {
    const double fourth = root * root * root * root;
    root -= (fourth * root - x) / (5.0 * fourth);
  }
  return x * x * root * root;
}

std::array<float, 256> linear_table() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const double c = i / 255.0;
    table[i] = static_cast<float>(c <= 0.04045 ? c / 12.92 : power_2_4((c + 0.055) / 1.055));
  }
  return table;
}

const std::array<float, 256>& linear_values() {
  static const std::array<float, 256> kTable = linear_table();
  return kTable;
}

}  // namespace

Color Ramp::at(float t) const {
  const float scaled = std::clamp(t, 0.0f, 1.0f) * 4.0f;
  const int low = std::min(static_cast<int>(scaled), 3);
  return mix(tones[low], tones[low + 1], scaled - static_cast<float>(low));
}

Ramp ramp(Color base, float spread) {
  const Color cool = mix(base * 0.45f, hex(0x2b2740), 0.35f);
  const Color warm = mix(base, hex(0xfff3d6), 0.6f);
  return {{mix(base, cool, spread), mix(base, cool, spread * 0.45f), base,
           mix(base, warm, spread * 0.4f), mix(base, warm, spread * 0.85f)}};
}

float linear_from_srgb(std::uint8_t coded) {
  return linear_values()[coded];
}

std::uint8_t srgb_from_linear(float linear) {
  const auto& table = linear_values();
  const auto above = std::lower_bound(table.begin(), table.end(), linear);
  if (above == table.begin()) return 0;
  if (above == table.end()) return 255;
  const auto index = static_cast<std::uint8_t>(above - table.begin());
  const bool lower_is_nearer = linear - above[-1] < above[0] - linear;
  return lower_is_nearer ? static_cast<std::uint8_t>(index - 1) : index;
}

std::uint8_t quantize(float coded) {
  return static_cast<std::uint8_t>(std::floor(std::clamp(coded, 0.0f, 1.0f) * 255.0f + 0.5f));
}

}  // namespace skerry::textures
