#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "tools/measure/picture.h"

namespace skerry::measure {

/// Pixels a degree of a viewer 0.7 m from a 0.7 m wide display of 3840 pixels: the papers' default.
inline constexpr double kPixelsPerDegree = 67.0206;

/// An error a pixel, 0..1.
struct ErrorMap {
  std::uint32_t width = 0, height = 0;
  std::vector<float> errors;  ///< width * height, rows from the top
};

/// FLIP of two pictures as displayed. Source: P. Andersson et al., FLIP: A Difference Evaluator for
/// Alternating Images, HPG 2020. Symmetric; 0 exactly where pictures are equal.
/// @param reference, test linear colour 0..1 of equal size (asserted); clamped, NaN is black.
ErrorMap flip_ldr(const Picture& reference, const Picture& test,
                  double pixels_per_degree = kPixelsPerDegree);

/// flip_ldr of 8-bit sRGB pixels, four bytes each of which the last is left out, without making
/// pictures of them: the same errors. @pre sizes are width * height * 4, and not 0 (asserted).
ErrorMap flip_srgb(std::uint32_t width, std::uint32_t height,
                   std::span<const std::uint8_t> reference, std::span<const std::uint8_t> test,
                   double pixels_per_degree = kPixelsPerDegree);

/// Exposures of HDR-FLIP [stops]: pictures are multiplied by 2^stop.
struct ExposureRange {
  double first = 0.0, last = 0.0;
  int count = 2;  ///< evenly spaced, both ends included
};

/// From the exposure that shows the reference's brightest pixel almost white (0.85 after the tone
/// curve) to the one that shows its median so; one exposure a stop, at least two (P. Andersson et
/// al., Visualizing Errors in Rendered High Dynamic Range Images, Eurographics 2021, section 4).
/// The paper takes the median luminance; here it is that of the pixels that are not black, because
/// in a world that is dark by default the median of all is often 0. An all-black reference takes
/// the range from `test`; two black pictures have the single stop 0. Pixels that are not finite do
/// not count.
ExposureRange exposure_range(const Picture& reference, const Picture& test);

/// HDR-FLIP: the largest flip_ldr over the exposures, a pixel; tone curve: the paper's ACES fit.
ErrorMap flip_hdr(const Picture& reference, const Picture& test, const ExposureRange& range,
                  double pixels_per_degree = kPixelsPerDegree);

/// Mean, quantile (nearest rank, 0..1) and largest of a map. @pre not empty; no error below 0.
double mean_of(const ErrorMap& map);
double quantile_of(const ErrorMap& map, double share);
double max_of(const ErrorMap& map);

}  // namespace skerry::measure
