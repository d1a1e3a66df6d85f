#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.h"

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

/// A PNG marked as sRGB. The bytes depend on the arguments alone. Text is stored as tEXt when it is
/// ASCII, else as iTXt (UTF-8). Errors: no pixels; no memory.
Result<std::vector<std::byte>> encode_png(const PixelView& image,
                                          std::span<const PngText> text = {});

/// Writes it by write_file. Errors: those of encode_png and write_file.
Result<void> write_png(const std::filesystem::path& path, const PixelView& image,
                       std::span<const PngText> text = {});

/// A PNG in memory, converted to 8 bits a channel, RGBA.
struct PngImage {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  ///< width * height * 4
  std::vector<PngText> text;
};

/// Limits of read_png, so that a small hostile file cannot ask for much memory.
inline constexpr std::uint64_t kMaxPngFileBytes = std::uint64_t{1} << 28;
inline constexpr std::uint32_t kMaxPngEdge = 1u << 15;
inline constexpr std::uint64_t kMaxPngPixels = std::uint64_t{1} << 27;  ///< 512 MiB

/// Errors: unreadable, not a PNG, damaged, beyond the limits.
Result<PngImage> read_png(const std::filesystem::path& path);

}  // namespace skerry::platform
