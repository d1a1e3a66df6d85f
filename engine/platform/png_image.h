// What a PNG holds, and how much of it is taken.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace skerry::platform {

/// A keyword (1 to 79 printable ASCII characters) and its text, stored in a PNG.
struct PngText {
  std::string key, text;
};

/// 8-bit sRGB pixels owned by someone else; rows from the top, no padding.
struct PixelView {
  std::uint32_t width = 0, height = 0;
  std::uint32_t channels = 4;            ///< 3 RGB, 4 RGBA
  std::span<const std::uint8_t> pixels;  ///< width * height * channels
};

/// A PNG in memory, converted to 8 bits a channel, RGBA.
struct PngImage {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  ///< width * height * 4
  std::vector<PngText> text;
};

/// Limits of reading, so that a small hostile file cannot ask for much memory.
inline constexpr std::uint64_t kMaxPngFileBytes = std::uint64_t{1} << 28;
inline constexpr std::uint32_t kMaxPngEdge = 1u << 15;
inline constexpr std::uint64_t kMaxPngPixels = std::uint64_t{1} << 27;  ///< 512 MiB
/// Deflate makes at most so many bytes of one. Source: zlib, Technical Details.
inline constexpr std::uint64_t kMaxDeflateRatio = 1032;

}  // namespace skerry::platform
