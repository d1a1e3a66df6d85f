// Whether a picture is its reference's, in numbers and in words. Plain values; no device.
#pragma once
#include <string>

#include "engine/core/result.h"
#include "engine/platform/image_file.h"
#include "game/scene_file/expectations.h"
#include "tools/measure/flip.h"

namespace skerry::tools {

/// How far two pictures of one size are apart; masked pixels do not count.
struct Difference {
  double flip_mean = 0.0, flip_p99 = 0.0, flip_max = 0.0;
  double psnr_db = 0.0;      ///< of linear light, peak 1; infinity for equal pictures
  double pixels_over = 0.0;  ///< share of pixels off by more than the tolerance's channel_threshold
  int largest = 0;           ///< largest difference of a channel, of 255

  bool equal() const { return largest == 0; }
};

/// A difference, and the picture of it.
struct Comparison {
  Difference difference;
  measure::ErrorMap flip;  ///< masked pixels are 0
};

/// @pre both have the same size, and masks leave something of it.
Comparison compare(const platform::PngImage& reference, const platform::PngImage& actual,
                   const game::Expectations& expected);

/// What is over the tolerance, in words; empty if nothing is.
std::string beyond(const Difference& found, const game::Tolerance& tolerance);

/// Whether hardly a pixel can be told from black.
bool is_black(const platform::PngImage& picture);

}  // namespace skerry::tools
