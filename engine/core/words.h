#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace skerry {

/// The 32-bit word `index` of a file, low byte first. @pre the file has that many.
inline std::uint32_t word_at(std::span<const std::byte> file, std::size_t index) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word |= std::to_integer<std::uint32_t>(file[index * 4 + i]) << (8 * i);
  return word;
}

}  // namespace skerry
