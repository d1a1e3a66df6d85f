// Pictures that are the same but for a move by some pixels.
#pragma once
#include "engine/platform/image_file.h"

namespace skerry::tools {

/// Where a picture was found: its pixel (x + dx, y + dy) is the reference's (x, y).
struct Shift {
  int dx = 0, dy = 0;
  bool operator==(const Shift&) const = default;
};

/// The shift of at most `most` pixels along each axis with the least mean difference of channels
/// over the pixels that have a partner; of equal ones the nearest.
/// @pre both have the same size, of more than `most` pixels along each axis.
Shift best_shift(const platform::PngImage& reference, const platform::PngImage& actual, int most);

/// The picture moved so that its pixels lie at the reference's; what comes from beyond its edges is
/// black.
platform::PngImage moved(const platform::PngImage& picture, const Shift& shift);

}  // namespace skerry::tools
