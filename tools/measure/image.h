#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "engine/core/result.h"
#include "tools/measure/flip.h"
#include "tools/measure/picture.h"

namespace skerry::measure {

/// 8-bit sRGB pixels as files hold them.
struct Image {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  ///< width * height * 4, rows from the top
};

/// Decoded; alpha is left out.
Picture picture_from(const Image& image);
/// Errors as colours, from black over blue-violet, red and orange to white; equally bright steps.
Image heat_map(const ErrorMap& map);
/// The colour of one error, 0..1.
std::array<std::uint8_t, 3> heat_color(double error);

/// Per channel, `gain` times the distance of the encoded bytes. @pre equal size (asserted).
Image amplified_difference(const Image& a, const Image& b, int gain);

/// Every `factor` pixels of each axis averaged in linear light; a remainder at the right and at the
/// bottom is averaged over what is there. @pre factor >= 1.
Image shrink(const Image& image, std::uint32_t factor);

/// Errors: see platform::write_png.
Result<void> write_image(const std::filesystem::path& path, const Image& image);

}  // namespace skerry::measure
