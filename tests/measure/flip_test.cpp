#include "tools/measure/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>

#include "tools/measure/color.h"
#include "tools/measure/flip_filters.h"
#include "tools/measure/flip_kernel.h"
#include "tools/measure/image.h"

namespace skerry::measure {
namespace {

constexpr double kPi = std::numbers::pi;

Picture constant(std::uint32_t width, std::uint32_t height, const glm::vec3& color) {
  return {width, height, std::vector<glm::vec3>(std::size_t{width} * height, color)};
}

Picture grey(float value) {
  return constant(8, 8, glm::vec3(value));
}

Picture random_picture(std::uint32_t width, std::uint32_t height, unsigned seed) {
  Picture picture = constant(width, height, glm::vec3(0));
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform;
  for (glm::vec3& pixel : picture.pixels)
    pixel = {uniform(random), uniform(random), uniform(random)};
  return picture;
}

double hyab_hunt(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 p = lab_from_linear(a), q = lab_from_linear(b);
  return std::abs(p.x - q.x) +
         std::hypot(0.01 * (p.x * p.y - q.x * q.y), 0.01 * (p.x * p.z - q.x * q.z));
}

/// The paper's error of a HyAB difference without features. The largest difference, green to blue,
/// from their tabulated L*a*b*: Hunt-adjusted (87.735, -75.612, 72.977) and (32.297, 25.575,
/// -34.836), so 55.438 + |(101.187, 107.813)| = 203.30.
double error_of(double hyab, double largest_hyab = 203.30) {
  const double largest = std::pow(largest_hyab, 0.7), knee = 0.4 * largest, d = std::pow(hyab, 0.7);
  return d < knee ? 0.95 * d / knee : 0.95 + 0.05 * (d - knee) / (largest - knee);
}

void expect_constant(const ErrorMap& map, double expected, double tolerance) {
  for (const float error : map.errors) ASSERT_NEAR(error, expected, tolerance);
}

// --- LDR ------------------------------------------------------------------------------------

TEST(Flip, EqualPicturesHaveNoError) {
  const Picture picture = random_picture(37, 70, 1);
  const ErrorMap map = flip_ldr(picture, picture);
  EXPECT_EQ(map.width, 37u);
  EXPECT_EQ(map.height, 70u);
  ASSERT_EQ(map.errors.size(), 37u * 70u);
  for (const float error : map.errors) EXPECT_EQ(error, 0.0f);
}

TEST(Flip, SwappingThePicturesChangesNothing) {
  const Picture a = random_picture(37, 70, 1), b = random_picture(37, 70, 2);
  EXPECT_EQ(flip_ldr(a, b).errors, flip_ldr(b, a).errors);
}

TEST(Flip, ConstantPicturesDifferByTheColorMetricAlone) {
  // Lightness alone: black and white are 100 apart.
  expect_constant(flip_ldr(grey(0), grey(1)), error_of(100.0), 1e-4);
  EXPECT_NEAR(error_of(100.0), 0.9674, 1e-4);
  // Greys 0.18 and 0.5: 76.0693 - 49.4961.
  expect_constant(flip_ldr(grey(0.18f), grey(0.5f)), error_of(26.5732), 1e-4);
  // Red against black: L* 53.24, Hunt-adjusted chroma 0.5324 * |(80.09, 67.20)| = 55.66.
  expect_constant(flip_ldr(constant(8, 8, {1, 0, 0}), grey(0)), error_of(53.24 + 55.66), 1e-4);
  // The two colours that define the largest error.
  expect_constant(flip_ldr(constant(8, 8, {0, 1, 0}), constant(8, 8, {0, 0, 1})), 1.0, 1e-4);
}

TEST(Flip, OnePixelIsAConstantPicture) {
  const Picture a = constant(1, 1, {0.2f, 0.4f, 0.1f}), b = constant(1, 1, {0.3f, 0.3f, 0.2f});
  const double expected = error_of(hyab_hunt({0.2, 0.4, 0.1}, {0.3, 0.3, 0.2}));
  ASSERT_EQ(flip_ldr(a, b).errors.size(), 1u);
  expect_constant(flip_ldr(a, b), expected, 1e-4);
}

TEST(Flip, GrowsWithTheDifference) {
  double last = 0.0;
  for (int step = 1; step <= 20; ++step) {
    const double error = mean_of(flip_ldr(grey(0), grey(static_cast<float>(step) / 20.0f)));
    EXPECT_GT(error, last);
    EXPECT_LE(error, 1.0);
    last = error;
  }
}

TEST(Flip, AnEdgeThatIsMissingWeighsMoreThanItsColor) {
  // Black against a step from black to grey: next to the step, the half of the edge filter that
  // sums to 1 sees the grey alone, so the feature is the grey's luminance. The colour there is the
  // grey blurred by a filter of which half lies on it, and the centre tap.
  const float level = 0.4f;
  Picture step = constant(64, 8, glm::vec3(0));
  for (std::size_t i = 0; i < step.pixels.size(); ++i)
    if (i % 64 >= 32) step.pixels[i] = glm::vec3(level);
  double sum = 0.0;
  for (int i = -10; i <= 10; ++i)
    sum += std::exp(-kPi * kPi * i * i / (kPixelsPerDegree * kPixelsPerDegree * 0.0047));
  const double blurred = level * (1.0 + 1.0 / sum) / 2.0;
  const double color = error_of(hyab_hunt(glm::dvec3(blurred), glm::dvec3(0)));
  const double expected = std::pow(color, 1.0 - std::sqrt(level / std::sqrt(2.0)));
  const ErrorMap map = flip_ldr(constant(64, 8, glm::vec3(0)), step);
  EXPECT_NEAR(map.errors[4 * 64 + 32], expected, 1e-4);
  EXPECT_GT(expected, color);
}

/// FLIP by definition: whole two-dimensional kernels, a pixel at a time.
class Definition {
 public:
  Definition(const Picture& a, const Picture& b, double ppd) : a_(a), b_(b), ppd_(ppd) {}

  double error_at(int x, int y) const {
    const double color =
        error_of(hyab_hunt(blurred(a_, x, y), blurred(b_, x, y)), hyab_hunt({0, 1, 0}, {0, 0, 1}));
    const double feature = std::max(std::abs(edge(a_, x, y) - edge(b_, x, y)),
                                    std::abs(point(a_, x, y) - point(b_, x, y)));
    return std::pow(color, 1.0 - std::sqrt(feature / std::sqrt(2.0)));
  }

 private:
  static glm::dvec3 pixel(const Picture& picture, int x, int y) {
    x = std::clamp(x, 0, static_cast<int>(picture.width) - 1);
    y = std::clamp(y, 0, static_cast<int>(picture.height) - 1);
    return picture.pixels[static_cast<std::size_t>(y) * picture.width + x];
  }

  static double csf(double z, double a1, double b1, double a2, double b2) {
    return a1 * std::sqrt(kPi / b1) * std::exp(-kPi * kPi * z / b1) +
           a2 * std::sqrt(kPi / b2) * std::exp(-kPi * kPi * z / b2);
  }

  glm::dvec3 blurred(const Picture& picture, int x, int y) const {
    const int r = static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2 * kPi * kPi)) * ppd_));
    glm::dvec3 sum(0.0), weights(0.0);
    for (int v = -r; v <= r; ++v) {
      for (int u = -r; u <= r; ++u) {
        const double z = (u * u + v * v) / (ppd_ * ppd_);
        const glm::dvec3 w(csf(z, 1, 0.0047, 0, 1e-5), csf(z, 1, 0.0053, 0, 1e-5),
                           csf(z, 34.1, 0.04, 13.5, 0.025));
        sum += w * ycxcz_from_linear(pixel(picture, x + u, y + v));
        weights += w;
      }
    }
    const glm::dvec3 linear = linear_from_ycxcz(sum / weights);
    return {std::clamp(linear.x, 0.0, 1.0), std::clamp(linear.y, 0.0, 1.0),
            std::clamp(linear.z, 0.0, 1.0)};
  }

  /// Magnitude over both axes of the filter kernel(u, v, deviation^2).
  template <class Kernel>
  double magnitude(const Picture& picture, int x, int y, const Kernel& kernel) const {
    const double deviation = 0.5 * 0.082 * ppd_;
    const int r = static_cast<int>(std::ceil(3.0 * deviation));
    double positive = 0.0, negative = 0.0;
    for (int v = -r; v <= r; ++v)
      for (int u = -r; u <= r; ++u) {
        const double w = kernel(u, v, deviation * deviation);
        (w > 0 ? positive : negative) += std::abs(w);
      }
    double along_x = 0.0, along_y = 0.0;
    for (int v = -r; v <= r; ++v)
      for (int u = -r; u <= r; ++u) {
        double w = kernel(u, v, deviation * deviation);
        w /= w > 0 ? positive : negative;
        along_x += w * luminance(pixel(picture, x + u, y + v));
        along_y += w * luminance(pixel(picture, x + v, y + u));
      }
    return std::hypot(along_x, along_y);
  }

  double edge(const Picture& picture, int x, int y) const {
    return magnitude(picture, x, y, [](double u, double v, double variance) {
      return -u * std::exp(-(u * u + v * v) / (2 * variance));
    });
  }

  double point(const Picture& picture, int x, int y) const {
    return magnitude(picture, x, y, [](double u, double v, double variance) {
      return (u * u / variance - 1) * std::exp(-(u * u + v * v) / (2 * variance));
    });
  }

  const Picture& a_;
  const Picture& b_;
  double ppd_;
};

/// Two pictures that differ in a few pixels, and a little in many.
std::pair<Picture, Picture> unlike(std::uint32_t width, std::uint32_t height) {
  Picture a = random_picture(width, height, 5), b = a;
  std::mt19937 random(6);
  for (int i = 0; i < 60; ++i) b.pixels[random() % b.pixels.size()] = glm::vec3(0.9f, 0.1f, 0.3f);
  for (std::size_t i = 0; i < b.pixels.size(); i += 3) b.pixels[i] *= 0.999f;
  return {a, b};
}

TEST(Flip, SeparatedFiltersGiveWhatTheDefinitionGives) {
  // Taller and wider than a tile, so that the seams are seen, and narrower than the filters.
  for (const std::uint32_t width : {15u, 70u}) {
    const auto [a, b] = unlike(width, 70);
    for (const double ppd : {kPixelsPerDegree, 20.0}) {
      const Definition definition(a, b, ppd);
      const ErrorMap map = flip_ldr(a, b, ppd);
      for (const int y : {0, 33, 63, 64, 69})
        for (const int x : {0, 7, 14, 63, 64, 69}) {
          if (x >= static_cast<int>(width)) continue;
          EXPECT_NEAR(map.errors[static_cast<std::size_t>(y) * width + x],
                      definition.error_at(x, y), 2e-6)
              << x << " " << y;
        }
    }
  }
}

TEST(Flip, SmallDifferencesKeepTheirPower) {
  // Where features are equal, so that the error is the 0.7th power of the colours' difference
  // alone.
  for (const double step : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    const auto a = static_cast<float>(0.3), b = static_cast<float>(0.3 + step);
    const double expected = error_of(hyab_hunt(glm::dvec3(a), glm::dvec3(b)));
    expect_constant(flip_ldr(grey(a), grey(b)), expected, expected * 1e-4);
  }
}

TEST(Flip, EveryKernelGivesTheSameBits) {
  const std::span<const flip_detail::Kernel* const> kernels = flip_detail::kernels();
  for (const std::uint32_t width : {1u, 7u, 64u, 131u}) {
    auto [a, b] = unlike(width, 67);
    b.pixels[0] = glm::vec3(std::numeric_limits<float>::quiet_NaN(), -1.0f, 2.0f);
    for (const double ppd : {kPixelsPerDegree, 20.0, 150.0}) {
      const std::vector<float> portable =
          errors_with(*kernels.back(), flip_detail::pair_of(a, b), ppd);
      EXPECT_GT(*std::max_element(portable.begin(), portable.end()), 0.1f);
      for (const flip_detail::Kernel* kernel : kernels) {
        const std::vector<float> errors = errors_with(*kernel, flip_detail::pair_of(a, b), ppd);
        EXPECT_EQ(0, std::memcmp(errors.data(), portable.data(), errors.size() * sizeof(float)))
            << kernel->name;
      }
    }
  }
}

TEST(Flip, BytesHaveTheErrorsOfThePictureThatTheyDecodeTo) {
  std::mt19937 random(8);
  Image a{131, 67, {}}, b{131, 67, {}};
  for (std::size_t i = 0; i < std::size_t{131} * 67 * 4; ++i) {
    a.rgba.push_back(static_cast<std::uint8_t>(random() % 256));
    b.rgba.push_back(random() % 4 != 0 ? a.rgba[i] : static_cast<std::uint8_t>(random() % 256));
  }
  EXPECT_EQ(flip_srgb(131, 67, a.rgba, b.rgba).errors,
            flip_ldr(picture_from(a), picture_from(b)).errors);
}

TEST(Flip, ADifferenceIsSeenInTheTilesAroundItAndInNoOther) {
  // One pixel beside the corner of four tiles: filters carry it into all of them, 10 pixels far.
  const Picture a = constant(200, 200, glm::vec3(0.2f));
  Picture b = a;
  b.pixels[64 * 200 + 63] = glm::vec3(1.0f);
  const ErrorMap map = flip_ldr(a, b);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x) {
      const float error = map.errors[static_cast<std::size_t>(y) * 200 + x];
      const int distance = std::max(std::abs(x - 63), std::abs(y - 64));
      if (distance <= 5) {
        EXPECT_GT(error, 0.0f) << x << " " << y;
      } else if (distance > 10) {
        EXPECT_EQ(error, 0.0f) << x << " " << y;
      }
    }
}

TEST(FlipFilters, WeightsSumToOne) {
  for (const double ppd : {5.0, 20.0, kPixelsPerDegree, 200.0}) {
    const FlipFilters filters(ppd);
    for (const SpatialFilter* filter :
         {&filters.achromatic, &filters.red_green, &filters.blue_yellow}) {
      double shares = 0.0;
      for (const SpatialFilter::Part& part : filter->parts) {
        double sum = -part.taps.weights[0];
        for (const double weight : part.taps.weights) sum += 2.0 * weight;
        EXPECT_NEAR(sum, 1.0, 1e-12);
        shares += part.share;
      }
      EXPECT_NEAR(shares, 1.0, 1e-12);
    }
    double edge = 0.0, point = -filters.point.weights[0];
    for (const double weight : filters.edge.weights) edge += weight;
    for (const double weight : filters.point.weights) point += 2.0 * weight;
    EXPECT_NEAR(edge, 1.0, 1e-12);
    EXPECT_NEAR(point, 0.0, 1e-12);
  }
}

TEST(Flip, WhatIsNoColorIsClamped) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(mean_of(flip_ldr(grey(nan), grey(0))), 0.0);
  EXPECT_EQ(mean_of(flip_ldr(grey(infinity), grey(1))), 0.0);
  EXPECT_EQ(mean_of(flip_ldr(grey(-1), grey(0))), 0.0);
}

// --- HDR ------------------------------------------------------------------------------------

/// K. Narkowicz' ACES fit, times 0.6.
double aces(double x) {
  x *= 0.6;
  return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

TEST(FlipHdr, ExposuresGoFromTheBrightestToTheMedian) {
  Picture picture = grey(0.25f);
  picture.pixels[3] = glm::vec3(16.0f);
  const ExposureRange range = exposure_range(picture, picture);
  EXPECT_NEAR(aces(16.0 * std::exp2(range.first)), 0.85, 1e-9);
  EXPECT_NEAR(aces(0.25 * std::exp2(range.last)), 0.85, 1e-9);
  EXPECT_EQ(range.count, 6);  // 16 / 0.25 are 6 stops
}

TEST(FlipHdr, BlackPixelsDoNotMoveTheMedian) {
  Picture picture = grey(0.0f);  // median of all: 0
  for (int i = 0; i < 5; ++i) picture.pixels[static_cast<std::size_t>(i)] = glm::vec3(0.25f);
  picture.pixels[9] = glm::vec3(16.0f);
  const ExposureRange range = exposure_range(picture, picture);
  EXPECT_NEAR(aces(0.25 * std::exp2(range.last)), 0.85, 1e-9);
  EXPECT_NEAR(aces(16.0 * std::exp2(range.first)), 0.85, 1e-9);
}

TEST(FlipHdr, BlackReferenceTakesTheRangeOfTheTest) {
  const ExposureRange range = exposure_range(grey(0), grey(4));
  EXPECT_NEAR(aces(4.0 * std::exp2(range.first)), 0.85, 1e-6);
  EXPECT_GT(mean_of(flip_hdr(grey(0), grey(4), range)), 0.9);
  const ExposureRange none = exposure_range(grey(0), grey(0));
  EXPECT_EQ(none.first, 0.0);
  EXPECT_EQ(none.last, 0.0);
  EXPECT_EQ(none.count, 1);
}

TEST(FlipHdr, EqualPicturesHaveNoError) {
  Picture picture = random_picture(20, 20, 3);
  picture.pixels[7] = glm::vec3(5000.0f);
  const ErrorMap map = flip_hdr(picture, picture, exposure_range(picture, picture));
  for (const float error : map.errors) EXPECT_EQ(error, 0.0f);
}

TEST(FlipHdr, IsTheWorstExposureOfEachPixel) {
  Picture a = grey(0.1f), b = a;
  for (std::size_t i = 0; i < 8; ++i) {
    a.pixels[i] = glm::vec3(100.0f);
    b.pixels[i] = glm::vec3(150.0f);  // seen in the darkest exposure alone
  }
  const ExposureRange range = exposure_range(a, b);
  const ErrorMap worst = flip_hdr(a, b, range);
  ErrorMap expected{8, 8, std::vector<float>(64)};
  for (int i = 0; i < range.count; ++i) {
    const double stop = range.first + i * (range.last - range.first) / (range.count - 1);
    Picture c = a, d = b;
    for (Picture* picture : {&c, &d})
      for (glm::vec3& pixel : picture->pixels)
        pixel = glm::vec3(static_cast<float>(std::min(aces(pixel.x * std::exp2(stop)), 1.0)));
    const ErrorMap map = flip_ldr(c, d);
    for (std::size_t p = 0; p < 64; ++p)
      expected.errors[p] = std::max(expected.errors[p], map.errors[p]);
  }
  for (std::size_t p = 0; p < 64; ++p) EXPECT_NEAR(worst.errors[p], expected.errors[p], 1e-4);
  EXPECT_GT(max_of(worst), 0.02);
  EXPECT_LT(mean_of(flip_hdr(a, b, {range.last, range.last, 1})), mean_of(worst));
}

TEST(FlipHdr, SurvivesWhatIsNotFinite) {
  Picture a = grey(1.0f), b = a;
  b.pixels[0] = glm::vec3(std::numeric_limits<float>::infinity());
  b.pixels[9] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
  for (const ErrorMap& map :
       {flip_hdr(a, b, exposure_range(a, b)), flip_hdr(b, a, exposure_range(b, a))}) {
    for (const float error : map.errors) {
      EXPECT_GE(error, 0.0f);
      EXPECT_LE(error, 1.0f);
    }
    EXPECT_GT(max_of(map), 0.1);
  }
}

// --- Pooling --------------------------------------------------------------------------------

TEST(ErrorMap, PoolsByNearestRank) {
  ErrorMap map{10, 10, {}};
  for (int i = 0; i < 100; ++i) map.errors.push_back(static_cast<float>((i * 37) % 100) / 100.0f);
  EXPECT_NEAR(mean_of(map), 0.495, 1e-6);
  EXPECT_FLOAT_EQ(static_cast<float>(quantile_of(map, 0.99)), 0.98f);
  EXPECT_FLOAT_EQ(static_cast<float>(quantile_of(map, 0.5)), 0.49f);
  EXPECT_FLOAT_EQ(static_cast<float>(quantile_of(map, 0.0)), 0.0f);
  EXPECT_FLOAT_EQ(static_cast<float>(quantile_of(map, 1.0)), 0.99f);
  EXPECT_FLOAT_EQ(static_cast<float>(max_of(map)), 0.99f);
}

}  // namespace
}  // namespace skerry::measure
