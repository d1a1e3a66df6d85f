#pragma once
#include <array>
#include <cstdint>

namespace skerry::textures {

/// sRGB-coded colour, 0..1 a channel: the space the palette is chosen and mixed in.
struct Color {
  float r = 0, g = 0, b = 0;
};

constexpr Color hex(std::uint32_t rgb) {
  return {static_cast<float>(rgb >> 16 & 255u) / 255.0f,
          static_cast<float>(rgb >> 8 & 255u) / 255.0f, static_cast<float>(rgb & 255u) / 255.0f};
}
constexpr Color mix(Color a, Color b, float t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}
constexpr Color operator*(Color c, float s) {
  return {c.r * s, c.g * s, c.b * s};
}

/// Five tones from shadow to highlight. Looked up with 0..1; 0.5 is the middle tone.
struct Ramp {
  std::array<Color, 5> tones;
  Color at(float t) const;
};

/// A ramp around `base`: shadows lean to a cool violet, highlights to a warm cream, as painters mix
/// them. `spread` 0..1 is how far the ends are from the base.
Ramp ramp(Color base, float spread);

/// Linear light of an 8-bit sRGB value (IEC 61966-2-1). Uses + - * / alone, so the bits are the
/// same with every compiler and C library.
float linear_from_srgb(std::uint8_t coded);
/// The 8-bit sRGB value whose linear light is nearest.
std::uint8_t srgb_from_linear(float linear);
/// Rounds a coded channel to 8 bits.
std::uint8_t quantize(float coded);

}  // namespace skerry::textures
