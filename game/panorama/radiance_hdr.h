#pragma once
#include <cstdint>
#include <string_view>

#include "engine/core/result.h"
#include "engine/render/sky/panorama.h"

namespace skerry::game {

/// Reads a Radiance picture (.hdr) whose rows run from the top and from the left, flat or
/// run-length encoded, of red, green and blue with a shared exponent; what it says of its EXPOSURE
/// is taken off. From any bytes; a picture takes memory only as its rows arrive.
/// Source: G. Ward, Real Pixels, Graphics Gems II, 1991, and the Radiance reference manual.
/// Errors, one line without the file's name: not such a file, XYZ colours, other directions, not
/// twice as wide as high, too large, cut short, damaged.
Result<render::Panorama> read_radiance_hdr(std::string_view bytes);

}  // namespace skerry::game
