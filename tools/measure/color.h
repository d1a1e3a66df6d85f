#pragma once
#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace skerry::measure {

/// Colour spaces of the FLIP papers, all relative to the white (1, 1, 1) of linear Rec. 709, whose
/// chromaticity is D65 (x 0.3127, y 0.3290). Values are not clamped.

/// XYZ over the white's XYZ from linear colour, and back.
const glm::dmat3& relative_from_linear();
const glm::dmat3& linear_from_relative();

/// Relative luminance Y (white: 1).
double luminance(const glm::dvec3& linear);

/// YCxCz: the linear form of L*a*b*, in which spatial filtering is a filtering of light.
/// Source: X. Zhang and B. Wandell, A spatial extension of CIELAB, 1997; white is (100, 0, 0) and
/// black (-16, 0, 0).
glm::dvec3 ycxcz_from_linear(const glm::dvec3& linear);
glm::dvec3 linear_from_ycxcz(const glm::dvec3& ycxcz);

/// CIE 1976 L*a*b*: white is (100, 0, 0), black (0, 0, 0).
glm::dvec3 lab_from_linear(const glm::dvec3& linear);

/// sRGB's transfer function (IEC 61966-2-1) of one channel, and back.
double srgb_from_linear(double linear);
double linear_from_srgb(double srgb);

/// The same of each byte of sRGB.
const std::array<float, 256>& linear_of_bytes();

}  // namespace skerry::measure
