// PNG as nearly all pictures are: RGB or RGBA, 8 bits a channel, not interlaced. Read whole with
// libdeflate, in a third of the time that libpng takes with zlib.
#pragma once
#include <optional>
#include <string_view>

#include "engine/platform/png_image.h"

namespace skerry::platform {

/// Reads a file of that kind. None: it is another kind of PNG (compressed text and transparent
/// colours included) or none at all, is damaged, or is beyond the limits of read_png, which then
/// reads it with libpng or says what is wrong.
/// Source: W3C, Portable Network Graphics, Third Edition, sections 5 (chunks) and 9 (filters).
std::optional<PngImage> read_plain_png(std::string_view file);

}  // namespace skerry::platform
