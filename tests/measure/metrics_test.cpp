#include "tools/measure/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace skerry::measure {
namespace {

Picture constant(const glm::vec3& color, std::size_t pixels = 16) {
  return {static_cast<std::uint32_t>(pixels), 1, std::vector<glm::vec3>(pixels, color)};
}

TEST(Metrics, EqualPicturesHaveNoError) {
  const Picture picture = constant({0.1f, 2.0f, 30.0f});
  EXPECT_EQ(rel_mse(picture, picture), 0.0);
  EXPECT_EQ(psnr(picture, picture), std::numeric_limits<double>::infinity());
}

TEST(Metrics, RelMseIsTheDefinition) {
  // Channels: 1/1.01, 4/4.01, 0.01/0.01 (black reference).
  const double expected = (1.0 / 1.01 + 4.0 / 4.01 + 0.01 / 0.01) / 3.0;
  EXPECT_NEAR(rel_mse(constant({1, 2, 0}), constant({2, 4, 0.1f})), expected, 1e-7);
  // One pixel of four wrong: a quarter of the error.
  Picture test = constant({1, 1, 1}, 4);
  test.pixels[2] = {2, 2, 2};
  EXPECT_NEAR(rel_mse(constant({1, 1, 1}, 4), test), 1.0 / 1.01 / 4.0, 1e-12);
}

TEST(Metrics, PsnrIsTheDefinition) {
  // Peak 2, error 0.02 everywhere: 20 log10(2 / 0.02) = 40 dB.
  EXPECT_NEAR(psnr(constant({2, 2, 2}), constant({2.02f, 1.98f, 2.02f})), 40.0, 1e-4);
  // Twice the error: 6.02 dB less.
  EXPECT_NEAR(psnr(constant({2, 2, 2}), constant({2.04f, 1.96f, 2.04f})), 33.9794, 1e-4);
}

TEST(Metrics, PsnrTakesThePeakBelowTheBrightestThousandth) {
  Picture reference = constant({1, 1, 1}, 2000), test = constant({1.1f, 1.1f, 1.1f}, 2000);
  for (Picture* picture : {&reference, &test}) picture->pixels[5] = {5000, 5000, 5000};
  EXPECT_NEAR(psnr(reference, test), 20.0 + 10.0 * std::log10(2000.0 / 1999.0), 1e-3);
}

TEST(Metrics, PsnrOfABlackReferenceTakesOne) {
  EXPECT_NEAR(psnr(constant({0, 0, 0}), constant({0.1f, 0.1f, 0.1f})), 20.0, 1e-5);
}

TEST(Metrics, NotANumberIsNotHidden) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(rel_mse(constant({1, 1, 1}), constant({nan, 1, 1}))));
  EXPECT_TRUE(std::isnan(psnr(constant({nan, nan, nan}), constant({1, 1, 1}))));
}

}  // namespace
}  // namespace skerry::measure
