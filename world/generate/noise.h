#pragma once
#include <cstdint>

// Integer noise. Nothing in this file or its users touches floating point: the voxels must be the
// same bits everywhere.
namespace skerry::world::noise {

/// Fixed-point formats: lengths in 1/256 block (Q8), fractions and noise values in 1/4096 (Q12).
inline constexpr int kOne8 = 256;
inline constexpr int kOne12 = 4096;

/// floor(sqrt(n)).
std::uint32_t isqrt(std::uint64_t n);

/// Length of (x, z), rounded down. @pre |x|, |z| < 2^31.
inline int length(std::int64_t x, std::int64_t z) {
  return static_cast<int>(isqrt(static_cast<std::uint64_t>(x * x + z * z)));
}

/// Sine of angle/1024 turns in Q12; off by less than 7 (Bhaskara's rational approximation).
int sine(int angle);
inline int cosine(int angle) {
  return sine(angle + 256);
}

/// 3t^2 - 2t^3 for t in Q12, clamped to 0..1.
constexpr int smooth(int t) {
  if (t <= 0) return 0;
  if (t >= kOne12) return kOne12;
  return static_cast<int>((static_cast<std::int64_t>(t) * t * (3 * kOne12 - 2 * t)) >> 24);
}

/// Gradient noise in Q12, within -4096..4096, zero at lattice points.
/// @param x, z place in Q8 blocks. @param wavelength blocks, 1..4096.
int gradient2(std::uint32_t seed, int x, int z, int wavelength);

/// Sum of octaves, each of half the wavelength and half the strength, within -8192..8192.
int fractal2(std::uint32_t seed, int x, int z, int wavelength, int octaves);

/// Ridges: 0 in valleys, up to 4096 on crests.
int ridge2(std::uint32_t seed, int x, int z, int wavelength, int octaves);

}  // namespace skerry::world::noise
