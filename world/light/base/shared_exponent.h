#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

namespace skerry::world {

/// Three non-negative numbers in a word: mantissas of 9 bits and an exponent that they share, as
/// VK_FORMAT_E5B9G9R9_UFLOAT_PACK32 has them. To the nearest; what is beyond 65408 becomes that,
/// what is below 2^-25 nothing.
inline std::uint32_t pack_shared_exponent(const glm::vec3& c) {
  constexpr float kMost = 65408.0f;
  const auto bounded = [&](float v) { return v > 0.0f ? std::min(v, kMost) : 0.0f; };
  const float r = bounded(c.x), g = bounded(c.y), b = bounded(c.z);
  const float most = std::max({r, g, b});
  // 2 to the exponent is more than the greatest.
  int exponent = std::max(static_cast<int>(std::bit_cast<std::uint32_t>(most) >> 23) - 126, -15);
  const auto step = [&] {
    return std::bit_cast<float>(static_cast<std::uint32_t>(136 - exponent) << 23);
  };
  if (most * step() + 0.5f >= 512.0f) ++exponent;
  const float steps = step();
  const auto mantissa = [steps](float v) {
    const float and_half = v * steps + 0.5f;  // not negative, so cutting off rounds
    return static_cast<std::uint32_t>(and_half);
  };
  return mantissa(r) | mantissa(g) << 9 | mantissa(b) << 18 |
         static_cast<std::uint32_t>(exponent + 15) << 27;
}

inline glm::vec3 unpack_shared_exponent(std::uint32_t word) {
  const float step = std::bit_cast<float>(((word >> 27) + 103u) << 23);  // 2 to the exponent - 24
  return step * glm::vec3(static_cast<float>(word & 511u), static_cast<float>(word >> 9 & 511u),
                          static_cast<float>(word >> 18 & 511u));
}

}  // namespace skerry::world
