#include "world/generate/noise.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>

#include "world/voxel/hash.h"

namespace skerry::world::noise {
namespace {

/// Dot product of an offset (Q12) with one of 16 gradients of length close to 1.5, picked by the
/// hash. Q12.
int gradient_dot(std::uint32_t hash, int x, int z) {
  static constexpr std::array<std::array<std::int16_t, 2>, 16> kGradients = {{{{384, 0}},
                                                                              {{355, 147}},
                                                                              {{272, 272}},
                                                                              {{147, 355}},
                                                                              {{0, 384}},
                                                                              {{-147, 355}},
                                                                              {{-272, 272}},
                                                                              {{-355, 147}},
                                                                              {{-384, 0}},
                                                                              {{-355, -147}},
                                                                              {{-272, -272}},
                                                                              {{-147, -355}},
                                                                              {{0, -384}},
                                                                              {{147, -355}},
                                                                              {{272, -272}},
                                                                              {{355, -147}}}};
  const auto& g = kGradients[hash >> 28];
  return (g[0] * x + g[1] * z) >> 8;
}

/// 6t^5 - 15t^4 + 10t^3 in Q12: no creases where cells meet.
int fade(int t) {
  const std::int64_t t1 = t;
  const std::int64_t inner = ((t1 * (6 * t1 - 15 * kOne12)) >> 12) + 10 * kOne12;
  return static_cast<int>((((((t1 * t1) >> 12) * t1) >> 12) * inner) >> 12);
}

int lerp12(int a, int b, int t) {
  return a + (((b - a) * t) >> 12);
}

/// Newton from above: the start is at least the root, and each step stays so until it stops
/// falling.
template <class Unsigned>
std::uint32_t newton_root(Unsigned n) {
  if (n == 0) return 0;
  auto root = static_cast<Unsigned>(Unsigned{1} << ((std::bit_width(n) + 1) / 2));
  for (;;) {
    const Unsigned next = (root + n / root) / 2;
    if (next >= root) return static_cast<std::uint32_t>(root);
    root = next;
  }
}

}  // namespace

std::uint32_t isqrt(std::uint64_t n) {
  // Short divisions are several times as fast as long ones, and nearly all lengths fit.
  return n >> 32 == 0 ? newton_root(static_cast<std::uint32_t>(n)) : newton_root(n);
}

int sine(int angle) {
  const int turn = angle & 1023;
  const std::int64_t half = (turn & 511) * (512 - (turn & 511));
  const auto value = static_cast<int>(16 * half * kOne12 / (5 * 512 * 512 - 4 * half));
  return turn < 512 ? value : -value;
}

int gradient2(std::uint32_t seed, int x, int z, int wavelength) {
  const int period = wavelength * kOne8;
  const auto cell = [period](int at) {
    return at >= 0 ? at / period : -((period - 1 - at) / period);
  };
  const int cx = cell(x);
  const int cz = cell(z);
  const int fx = (x - cx * period) * 16 / wavelength;
  const int fz = (z - cz * period) * 16 / wavelength;
  const int v00 = gradient_dot(hash2(seed, cx, cz), fx, fz);
  const int v10 = gradient_dot(hash2(seed, cx + 1, cz), fx - kOne12, fz);
  const int v01 = gradient_dot(hash2(seed, cx, cz + 1), fx, fz - kOne12);
  const int v11 = gradient_dot(hash2(seed, cx + 1, cz + 1), fx - kOne12, fz - kOne12);
  const int u = fade(fx);
  return std::clamp(lerp12(lerp12(v00, v10, u), lerp12(v01, v11, u), fade(fz)), -kOne12, kOne12);
}

int fractal2(std::uint32_t seed, int x, int z, int wavelength, int octaves) {
  int sum = 0;
  for (int i = 0; i < octaves; ++i) {
    sum += gradient2(seed + static_cast<std::uint32_t>(i), x, z, std::max(1, wavelength >> i)) >> i;
  }
  return sum;
}

int ridge2(std::uint32_t seed, int x, int z, int wavelength, int octaves) {
  int sum = 0;
  for (int i = 0; i < octaves; ++i) {
    const int n =
        gradient2(seed + static_cast<std::uint32_t>(i), x, z, std::max(1, wavelength >> i));
    sum += (kOne12 - 2 * std::abs(n)) >> (i + 1);
  }
  return std::clamp(sum, 0, kOne12);
}

}  // namespace skerry::world::noise
