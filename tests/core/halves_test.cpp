#include "engine/core/halves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace skerry {
namespace {

std::uint16_t half_of(float number) {
  std::array<std::uint16_t, 1> out{};
  halves_of(std::array{number}, out);
  return out[0];
}

/// What a half of a positive sign is, by the format's definition.
double value_of(int half) {
  const int exponent = half >> 10, fraction = half & 0x3ff;
  return exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
}

constexpr int kLargest = 0x7bff;  // 65504

TEST(Halves, AreThemselvesAndTakeWhatIsNearest) {
  for (int half = 0; half <= kLargest; ++half) {
    const double here = value_of(half);
    ASSERT_EQ(half_of(static_cast<float>(here)), half);
    ASSERT_EQ(half_of(static_cast<float>(-here)), half | 0x8000);
    if (half == kLargest) break;
    // Between two of them, exact as a float: the larger one; the next float below: the smaller one.
    const auto middle = static_cast<float>(0.5 * (here + value_of(half + 1)));
    ASSERT_EQ(half_of(middle), half + 1) << middle;
    const float below = std::nextafter(middle, 0.0f);
    ASSERT_EQ(half_of(below), half) << below;
  }
}

TEST(Halves, OfAnyFloatAreAsNearAsAnyAndFinite) {
  std::mt19937_64 random(3);
  std::vector<float> numbers(4099);
  std::uniform_real_distribution<float> exponent(-30.0f, 18.0f), sign(-1.0f, 1.0f);
  for (float& number : numbers) number = std::copysign(std::exp2(exponent(random)), sign(random));
  std::vector<std::uint16_t> halves(numbers.size());
  halves_of(numbers, halves);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const int half = halves[i] & 0x7fff;
    const double size = std::abs(static_cast<double>(numbers[i]));
    ASSERT_LE(half, kLargest);
    EXPECT_EQ(halves[i] >> 15, numbers[i] < 0.0f ? 1 : 0);
    for (const int other : {std::max(half - 1, 0), std::min(half + 1, kLargest)})
      EXPECT_LE(std::abs(value_of(half) - size), std::abs(value_of(other) - size)) << numbers[i];
  }
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float number : {65520.0f, 1e30f, kInfinity, std::nanf("")})
    EXPECT_EQ(half_of(number), kLargest) << number;
  EXPECT_EQ(half_of(-kInfinity), kLargest | 0x8000);
}

}  // namespace
}  // namespace skerry
