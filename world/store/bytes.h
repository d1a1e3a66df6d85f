// Numbers as bytes of a file: little-endian, on any machine.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "world/voxel/hash.h"

namespace skerry::world {

class ByteWriter {
 public:
  void u8(std::uint8_t v) { bytes_.push_back(std::byte{v}); }
  void u16(std::uint16_t v) { number(v, 2); }
  void u32(std::uint32_t v) { number(v, 4); }
  void u64(std::uint64_t v) { number(v, 8); }
  void i64(std::int64_t v) { u64(static_cast<std::uint64_t>(v)); }
  void f64(double v) { u64(std::bit_cast<std::uint64_t>(v)); }
  void text(std::string_view v) {
    u32(static_cast<std::uint32_t>(v.size()));
    const auto raw = std::as_bytes(std::span(v));
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
  }
  /// Bytes as they are, without their count.
  void raw(std::span<const std::byte> v) { bytes_.insert(bytes_.end(), v.begin(), v.end()); }
  std::span<const std::byte> bytes() const { return bytes_; }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void number(std::uint64_t v, int count) {
    for (int i = 0; i < count; ++i) bytes_.push_back(static_cast<std::byte>(v >> 8 * i & 0xff));
  }
  std::vector<std::byte> bytes_;
};

/// Reads what ByteWriter wrote. Past the end everything is 0 and done() false.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::uint8_t u8() { return static_cast<std::uint8_t>(number(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(number(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  std::uint64_t u64() { return number(8); }
  std::int64_t i64() { return static_cast<std::int64_t>(u64()); }
  double f64() { return std::bit_cast<double>(u64()); }
  /// @return empty, and not done(), when longer than `most`.
  std::string text(std::size_t most) {
    const std::size_t size = u32();
    if (size > most || size > bytes_.size()) {
      short_ = true;
      return {};
    }
    std::string out(reinterpret_cast<const char*>(bytes_.data()), size);
    bytes_ = bytes_.subspan(size);
    return out;
  }
  /// Whether there was enough, and all of it has been read.
  bool done() const { return !short_ && bytes_.empty(); }
  /// Whether more was read than there is; what was read beyond the end is 0.
  bool cut_short() const { return short_; }

 private:
  std::uint64_t number(std::size_t count) {
    if (bytes_.size() < count) {
      short_ = true;
      bytes_ = {};
      return 0;
    }
    std::uint64_t v = 0;
    for (std::size_t i = 0; i < count; ++i) v |= std::to_integer<std::uint64_t>(bytes_[i]) << 8 * i;
    bytes_ = bytes_.subspan(count);
    return v;
  }
  std::span<const std::byte> bytes_;
  bool short_ = false;
};

/// A checksum: of two texts that differ, one pair in 2^64 shares it.
inline std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t seed = 0) {
  std::uint64_t h = mix64(seed ^ (bytes.size() * 0x9e3779b97f4a7c15u));
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const std::size_t count = bytes.size() < 8 ? bytes.size() : 8;
    std::memcpy(&word, bytes.data(), count);
    if constexpr (std::endian::native == std::endian::big) word = __builtin_bswap64(word);
    h = mix64(h ^ word) + 0x9e3779b97f4a7c15u;
    bytes = bytes.subspan(count);
  }
  return h;
}

}  // namespace skerry::world
