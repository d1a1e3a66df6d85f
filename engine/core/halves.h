#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace skerry {

/// IEEE 754 half-precision numbers next to floats, the larger of two that are as near. Magnitudes
/// beyond the largest half, infinity and NaN become the largest half. Without branches, for vectors
/// of them. @param out as many as `numbers`.
inline void halves_of(std::span<const float> numbers, std::span<std::uint16_t> out) {
  constexpr std::int32_t kMagnitude = 0x7fff'ffff, kLargest = 0x477f'e000;  // 65504
  constexpr std::int32_t kExponents = (127 - 15) << 23, kTie = 1 << 12;
  constexpr std::int32_t kLeastNormal = kExponents + (1 << 23);  // 2^-14
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto bits = std::bit_cast<std::int32_t>(numbers[i]);
    const std::int32_t size = std::min(bits & kMagnitude, kLargest);
    const std::int32_t normal = (size - kExponents + kTie) >> 13;
    // Below that they are even: multiples of 2^-24.
    const float few = std::bit_cast<float>(std::min(size, kLeastNormal));
    const std::int32_t even = (static_cast<std::int32_t>(few * 0x1p25f) + 1) >> 1;
    out[i] =
        static_cast<std::uint16_t>((size < kLeastNormal ? even : normal) | (bits >> 16 & 0x8000));
  }
}

}  // namespace skerry
