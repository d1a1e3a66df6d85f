// Whether a picture is its reference's, in numbers and in words. Plain values; no device.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/platform/image_file.h"
#include "game/scene_file/expectations.h"
#include "tools/measure/flip.h"
#include "tools/skerry/compare/shift.h"

namespace skerry::tools {

/// How far two pictures of one size are apart; masked pixels do not count.
struct Difference {
  double flip_mean = 0.0, flip_p99 = 0.0, flip_max = 0.0;
  double psnr_db = 0.0;      ///< of linear light, peak 1; infinity for equal pictures
  double pixels_over = 0.0;  ///< share of pixels off by more than the tolerance's channel_threshold
  int largest = 0;           ///< largest difference of a channel, of 255
  double pixels_rounded = 0.0;  ///< share of pixels off by no more than the tolerance's code_values
  double bias =
      0.0;  ///< of the channel where it is largest: sum of what those are off by, over the
            ///< number of all pixels [code values]; above 0: brighter than the reference

  bool equal() const { return largest == 0; }
};

/// The difference of a region of a picture, or of what lies in none (game::kElsewhere).
struct PartDifference {
  std::string name;
  Difference difference;
};

/// A difference, and the picture of it.
struct Comparison {
  Difference difference;              ///< of the whole picture, with the scene's own limits
  std::vector<PartDifference> parts;  ///< none: the scene states no region
  std::optional<Shift> shift;         ///< none: the scene allows none
  measure::ErrorMap flip;             ///< pixels that are not compared are 0
};

/// Compares a picture with a reference as a scene expects it: at the offset within the stated shift
/// that has the least mean difference of bytes, of equal ones the nearest; what then lies beyond an
/// edge of the picture does not count. FLIP sees the reference's pixel in place of one that is off
/// by no more than code_values. Its filters reach 10 pixels over the border of a region.
/// @pre both have the same size, which check_expectations has accepted.
Comparison compare(const platform::PngImage& reference, const platform::PngImage& actual,
                   const game::Expectations& expected);

/// What is over the tolerance, in words; empty if nothing is.
std::string beyond(const Difference& found, const game::Tolerance& tolerance);
/// The same of all parts, each by its own tolerance.
/// @param parts of a comparison with the same expectations; without any, all is one part.
std::string beyond(const Difference& found, std::span<const PartDifference> parts,
                   const game::Expectations& expected);

/// Whether hardly a pixel can be told from black.
bool is_black(const platform::PngImage& picture);

}  // namespace skerry::tools
