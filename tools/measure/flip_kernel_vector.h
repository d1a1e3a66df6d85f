// Vectors of doubles, and functions of them that are exact to 1e-12 of their value. Included by
// each kernel, which says its vectors' length and its instruction set: no include guard.
#include <cstdint>
#include <cstring>

namespace skerry::measure::flip_detail {
namespace {

typedef double Vec __attribute__((vector_size(8 * SKERRY_FLIP_LANES)));
typedef std::uint64_t Bits __attribute__((vector_size(8 * SKERRY_FLIP_LANES)));

constexpr int kLanes = SKERRY_FLIP_LANES;

SKERRY_FLIP_TARGET inline Vec load(const double* from) {
  Vec out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

SKERRY_FLIP_TARGET inline void store(double* to, const Vec& value) {
  std::memcpy(to, &value, sizeof value);
}

SKERRY_FLIP_TARGET inline Vec all(double value) {
  return Vec{} + value;
}

SKERRY_FLIP_TARGET inline Bits bits_of(const Vec& value) {
  return reinterpret_cast<Bits>(value);
}

SKERRY_FLIP_TARGET inline Vec from_bits(const Bits& bits) {
  return reinterpret_cast<Vec>(bits);
}

SKERRY_FLIP_TARGET inline Vec largest_of(const Vec& a, const Vec& b) {
  return a > b ? a : b;
}

/// Into 0..1; what is no number becomes 0.
SKERRY_FLIP_TARGET inline Vec clamp_unit(const Vec& x) {
  const Vec positive = x > all(0.0) ? x : all(0.0);
  return positive < all(1.0) ? positive : all(1.0);
}

SKERRY_FLIP_TARGET inline Vec magnitude(const Vec& x) {
  return from_bits(bits_of(x) & ~std::uint64_t{0} >> 1);
}

// A double of 2^52 and more holds a whole number in its low bits.
constexpr double kTwo52 = 4503599627370496.0;
constexpr std::uint64_t kTwo52Bits = 0x4330000000000000;

/// 1 / the p-th root of x, to 4%: the upper half of a number's bits is nearly its logarithm.
/// @pre x is normal and positive. Source: W. Kahan and K. C. Ng, FreeBSD's cbrt, for the root of 3.
template <int p>
SKERRY_FLIP_TARGET inline Vec inverse_root_estimate(const Vec& x) {
  constexpr double kBalance = p == 3 ? 0.066 : 0.059;  // makes the largest errors equal
  constexpr double kOffset = 1048576.0 * (1023.0 * (1.0 + 1.0 / p) - kBalance);
  const Vec upper = from_bits(bits_of(x) >> 32 | kTwo52Bits) - kTwo52;
  return from_bits(bits_of((kOffset + kTwo52) - upper * (1.0 / p)) << 32);
}

/// x^(-1/3). @pre as above. Two steps of the series of (1 - h)^(-1/3), h = 1 - x z^3, without a
/// division.
SKERRY_FLIP_TARGET inline Vec inverse_cube_root(const Vec& x) {
  Vec z = inverse_root_estimate<3>(x);
  for (int step = 0; step < 2; ++step) {
    const Vec h = 1.0 - x * (z * z * z);
    z += z * h * (1.0 / 3.0 + h * (2.0 / 9.0 + h * (14.0 / 81.0)));
  }
  return z;
}

/// x^(-1/5), in the same way.
SKERRY_FLIP_TARGET inline Vec inverse_fifth_root(const Vec& x) {
  Vec z = inverse_root_estimate<5>(x);
  for (int step = 0; step < 2; ++step) {
    const Vec z2 = z * z, h = 1.0 - x * (z2 * z2 * z);
    z += z * h * (1.0 / 5.0 + h * (3.0 / 25.0 + h * (11.0 / 125.0)));
  }
  return z;
}

/// log2(x). @pre x is normal and positive.
SKERRY_FLIP_TARGET inline Vec log_2(const Vec& x) {
  // x = m 2^k with m from sqrt(1/2) to sqrt(2); log m = 2 artanh((m - 1) / (m + 1)).
  constexpr std::uint64_t kOne = 0x3ff0000000000000, kRootHalf = 0x3fe6a09e667f3bcd;
  const Bits biased = (bits_of(x) + (kOne - kRootHalf)) >> 52;  // k + 1023
  const Vec k = from_bits(biased | kTwo52Bits) - (kTwo52 + 1023.0);
  const Vec m = from_bits(bits_of(x) - (biased << 52) + kOne);
  const Vec s = (m - 1.0) / (m + 1.0), s2 = s * s;
  Vec sum = all(1.0 / 13.0);
  for (const double term : {1.0 / 11.0, 1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0, 1.0})
    sum = sum * s2 + term;
  constexpr double kTwoOverLn2 = 2.8853900817779268;
  return k + kTwoOverLn2 * s * sum;
}

/// 2^z. @pre -1000 <= z <= 1000.
SKERRY_FLIP_TARGET inline Vec exp_2(const Vec& z) {
  constexpr double kRounds = 1.5 * kTwo52;  // a sum with it has no bits behind the point
  constexpr double kLn2 = 0.69314718055994531;
  const Vec shifted = z + kRounds;
  const Vec x = (z - (shifted - kRounds)) * kLn2;  // -0.35..0.35
  Vec sum = all(1.0 / 3628800.0);
  for (const double term : {1.0 / 362880.0, 1.0 / 40320.0, 1.0 / 5040.0, 1.0 / 720.0, 1.0 / 120.0,
                            1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0})
    sum = sum * x + term;
  return from_bits(bits_of(sum) + (bits_of(shifted) << 52));
}

}  // namespace
}  // namespace skerry::measure::flip_detail
