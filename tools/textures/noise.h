#pragma once
#include <cstdint>

namespace skerry::textures {

/// Edge of a block texture [texels]; noise repeats with this period.
inline constexpr int kEdge = 32;

/// A wrapped texel coordinate, for any integer.
constexpr int wrap(int i) {
  return ((i % kEdge) + kEdge) % kEdge;
}

/// Well-mixed bits of a lattice point. Finaliser: fmix32 of A. Appleby's MurmurHash3 (public
/// domain).
constexpr std::uint32_t hash(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
  std::uint32_t h = x * 0x8da6b343u ^ y * 0xd8163841u ^ (seed + 1u) * 0x9e3779b9u;
  h ^= h >> 16;
  h *= 0x85ebca6bu;
  h ^= h >> 13;
  h *= 0xc2b2ae35u;
  return h ^ h >> 16;
}

/// hash() as a number in [0, 1), a multiple of 2^-24 and so exact in a float.
constexpr float unit(int x, int y, std::uint32_t seed) {
  return static_cast<float>(
             hash(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), seed) >> 8) *
         (1.0f / 16777216.0f);
}

constexpr float absolute(float value) {
  return value < 0.0f ? -value : value;
}

/// Cells of a wrap-around lattice along a tile's edges.
struct Cells {
  int x, y;
};

/// Gradient noise at a texel position, about -0.7..0.7, mean 0. Source: K. Perlin, Improving Noise
/// (2002).
float gradient_noise(float x, float y, Cells cells, std::uint32_t seed);
/// gradient_noise() at the centre of a texel.
float noise_at(int x, int y, Cells cells, std::uint32_t seed);
/// Sum of `octaves` gradient noises, each with twice the cells and half the weight.
float fbm(float x, float y, Cells cells, int octaves, std::uint32_t seed);

/// The two nearest feature points. Source: S. Worley, A Cellular Texture Basis Function (1996).
struct Cellular {
  float nearest, second;  ///< distances in cells, scaled so that anisotropic cells measure alike
  std::uint32_t id;       ///< hash of the nearest point's cell
};
/// @param jitter 0: a regular grid, 1: anywhere in the cell.
Cellular cellular(float x, float y, Cells cells, float jitter, std::uint32_t seed);
/// cellular() at the centre of a texel.
Cellular cell_at(int x, int y, Cells cells, float jitter, std::uint32_t seed);
/// A number in [0, 1) for a cell.
float cell_unit(const Cellular& cell, std::uint32_t seed);

struct Point {
  float x, y;
};
/// Point i of a sequence that fills the tile evenly, 0..kEdge, moved about a little so that no
/// lattice shows. Source: M. Roberts, The Unreasonable Effectiveness of Quasirandom Sequences
/// (2018), R2.
Point spread_point(int i, std::uint32_t seed);

/// A stream of random numbers for brush strokes. Take one at most in a call's arguments: compilers
/// evaluate those in any order. Braced initialisers are ordered.
class Random {
 public:
  explicit Random(std::uint32_t seed) : seed_(seed) {}
  float next() { return unit(counter_++, 0x51ab, seed_); }
  float range(float low, float high) { return low + (high - low) * next(); }
  int below(int n) { return static_cast<int>(next() * static_cast<float>(n)); }

 private:
  std::uint32_t seed_;
  int counter_ = 0;
};

}  // namespace skerry::textures
