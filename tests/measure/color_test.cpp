#include "tools/measure/color.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

namespace skerry::measure {
namespace {

void expect_near(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c], expected[c], tolerance) << "channel " << c;
}

TEST(Color, LuminanceIsThatOfRec709) {
  // The standard's own rounded coefficients.
  EXPECT_NEAR(luminance({1, 0, 0}), 0.2126, 5e-5);
  EXPECT_NEAR(luminance({0, 1, 0}), 0.7152, 5e-5);
  EXPECT_NEAR(luminance({0, 0, 1}), 0.0722, 5e-5);
  EXPECT_NEAR(luminance({1, 1, 1}), 1.0, 1e-12);
}

TEST(Color, LabOfThePrimariesIsThePublishedOne) {
  // Commonly tabulated CIELAB of the sRGB primaries under D65.
  expect_near(lab_from_linear({1, 0, 0}), {53.24, 80.09, 67.20}, 0.02);
  expect_near(lab_from_linear({0, 1, 0}), {87.73, -86.18, 83.18}, 0.02);
  expect_near(lab_from_linear({0, 0, 1}), {32.30, 79.19, -107.86}, 0.02);
  expect_near(lab_from_linear({1, 1, 1}), {100, 0, 0}, 1e-9);
  expect_near(lab_from_linear({0, 0, 0}), {0, 0, 0}, 1e-9);
  // Grey 0.18: 116 * 0.18^(1/3) - 16 = 116 * 0.564622 - 16.
  expect_near(lab_from_linear({0.18, 0.18, 0.18}), {49.4961, 0, 0}, 1e-4);
  // Grey 0.001 lies on the straight part: 116 * 0.001 * (29/6)^2 / 3 = 0.903296.
  expect_near(lab_from_linear({0.001, 0.001, 0.001}), {0.903296, 0, 0}, 1e-6);
}

TEST(Color, YcxczIsLinearInLight) {
  expect_near(ycxcz_from_linear({1, 1, 1}), {100, 0, 0}, 1e-9);
  expect_near(ycxcz_from_linear({0, 0, 0}), {-16, 0, 0}, 1e-9);
  expect_near(ycxcz_from_linear({0.5, 0.5, 0.5}), {42, 0, 0}, 1e-9);
  // Red: X/Xn = 0.4124 / 0.9505 = 0.4339, Y = 0.2126, Z/Zn = 0.0193 / 1.0891 = 0.0177.
  expect_near(ycxcz_from_linear({1, 0, 0}), {116 * 0.2126 - 16, 110.6, 38.98}, 0.05);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 2.0);
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 color(uniform(random), uniform(random), uniform(random));
    expect_near(linear_from_ycxcz(ycxcz_from_linear(color)), color, 1e-12);
  }
}

TEST(Color, SrgbIsTheStandardsCurve) {
  EXPECT_NEAR(srgb_from_linear(0.5), 0.735357, 1e-6);  // 1.055 * 0.5^(1/2.4) - 0.055
  EXPECT_NEAR(srgb_from_linear(0.001), 0.01292, 1e-9);
  EXPECT_NEAR(linear_from_srgb(0.5), 0.214041, 1e-6);
  for (int byte = 0; byte < 256; ++byte)
    EXPECT_NEAR(srgb_from_linear(linear_from_srgb(byte / 255.0)), byte / 255.0, 1e-6);
}

}  // namespace
}  // namespace skerry::measure
