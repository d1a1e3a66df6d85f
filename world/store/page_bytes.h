// Bytes of SQLite's files. Private to world/store.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <istream>
#include <span>

namespace skerry::world {

/// Size of all pages of a world file [bytes].
inline constexpr std::size_t kPageBytes = 4096;
using PageBytes = std::array<std::byte, kPageBytes>;

inline std::uint64_t big_endian(std::span<const std::byte> bytes) {
  std::uint64_t value = 0;
  for (const std::byte b : bytes) value = value << 8 | std::to_integer<std::uint64_t>(b);
  return value;
}

/// @return false: the file ends before `out` is full.
inline bool read_at(std::istream& file, std::uint64_t at, std::span<std::byte> out) {
  file.clear();
  file.seekg(static_cast<std::streamoff>(at));
  file.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size()));
  return file.gcount() == static_cast<std::streamsize>(out.size());
}

}  // namespace skerry::world
