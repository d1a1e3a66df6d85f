#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "engine/platform/png_image.h"

namespace skerry::platform {

/// A PNG marked as sRGB. The bytes depend on the arguments alone. Text is stored as tEXt when it is
/// ASCII, else as iTXt (UTF-8). Errors: no pixels; no memory.
Result<std::vector<std::byte>> encode_png(const PixelView& image,
                                          std::span<const PngText> text = {});

/// Writes it by write_file. Errors: those of encode_png and write_file.
Result<void> write_png(const std::filesystem::path& path, const PixelView& image,
                       std::span<const PngText> text = {});

/// Errors: unreadable, not a PNG, damaged, beyond the limits.
Result<PngImage> read_png(const std::filesystem::path& path);
/// The same of a file's bytes. @param name what errors call it.
Result<PngImage> decode_png(std::string_view file, std::string_view name);

}  // namespace skerry::platform
