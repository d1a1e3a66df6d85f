// Tone curves and display: properties, and values that others have published.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/render/frame/display.h"
#include "tools/reference/reference.h"

namespace skerry::reference {
namespace {

using render::ToneCurve;

constexpr ToneCurve kCurves[] = {ToneCurve::kAces, ToneCurve::kAgx};

TEST(ToneCurves, GiveExactlyNothingForNothing) {
  for (const ToneCurve curve : kCurves)
    EXPECT_EQ(tone_mapped(glm::dvec3(0.0), curve), glm::dvec3(0.0));
}

TEST(ToneCurves, OfGreyRiseAllTheWayAndStayWithinTheDisplay) {
  for (const ToneCurve curve : kCurves) {
    double last = 0.0;
    for (double stops = -24.0; stops < 20.0; stops += 0.01) {
      const glm::dvec3 seen = tone_mapped(glm::dvec3(std::exp2(stops)), curve);
      for (int i = 0; i < 3; ++i) EXPECT_TRUE(seen[i] >= 0.0 && seen[i] <= 1.0) << stops;
      EXPECT_GE(seen.y, last - 1e-12) << stops;
      last = seen.y;
    }
    EXPECT_GT(last, 0.98);
  }
}

/// Light of things that glow: lava and its crust, crystals and their dark parts, a flame from the
/// rim to its core, each as the texels of one block have it.
constexpr glm::dvec3 kGlowing[][2] = {{{0.9, 0.30, 0.06}, {0.45, 0.10, 0.02}},
                                      {{0.45, 0.72, 0.92}, {0.22, 0.45, 0.75}},
                                      {{0.60, 0.35, 0.90}, {0.30, 0.15, 0.60}},
                                      {{1.0, 0.745, 0.254}, {0.64, 0.095, 0.014}}};

TEST(ToneCurves, ShowTheShapeOfWhatIsFarBrighterThanWhite) {
  const auto encoded = [](glm::dvec3 light) {
    const glm::dvec3 c = tone_mapped(light, ToneCurve::kAces);
    return glm::dvec3(render::srgb_encoded(c.x), render::srgb_encoded(c.y),
                      render::srgb_encoded(c.z));
  };
  for (const auto& [bright, dark] : kGlowing)
    for (double stops = 2.0; stops <= 14.0; stops += 0.25) {
      const double light = std::exp2(stops);
      const glm::dvec3 a = encoded(bright * light), b = encoded(dark * light);
      // Its parts differ by 16 of 255 in a channel.
      EXPECT_GT(std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)}), 0.06)
          << stops;
      // And it is no white: its weakest channel stays a twentieth below its strongest.
      for (const glm::dvec3& c : {a, b})
        EXPECT_LT(std::min({c.x, c.y, c.z}), 0.95 * std::max({c.x, c.y, c.z})) << stops;
    }
}

// Shade at noon has an eighth of the light of sunlit ground. The published fit alone makes it a
// twenty-fourth.
TEST(ToneCurves, AddNoContrastToShade) {
  const auto shown = [](double light) {
    return tone_mapped(light * glm::dvec3(0.8, 1.0, 0.5), ToneCurve::kAces).y;
  };
  for (double sunlit = 0.12; sunlit < 0.5; sunlit *= 1.1)
    EXPECT_LT(shown(sunlit), 8.0 * shown(sunlit / 8.0)) << sunlit;
}

TEST(ToneCurves, OfAColourNeverDarkenAndKeepTheOrderOfItsChannels) {
  for (const auto& pair : kGlowing)
    for (const glm::dvec3& light : pair) {
      double last = 0.0;
      for (double stops = -10.0; stops < 24.0; stops += 0.02) {
        const glm::dvec3 c = tone_mapped(light * std::exp2(stops), ToneCurve::kAces);
        const double y = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
        ASSERT_GE(y, last - 1e-6) << stops;
        ASSERT_LT(y, last + 0.01) << stops;  // no step where the brightest are drawn together
        EXPECT_EQ(light.x > light.z, c.x > c.z) << stops;
        last = y;
      }
    }
}

TEST(ToneCurves, KeepAnyColourWithinTheDisplay) {
  for (const ToneCurve curve : kCurves)
    for (double r = 0.0; r < 100.0; r = 3.0 * r + 0.01)
      for (double g = 0.0; g < 100.0; g = 3.0 * g + 0.01)
        for (double b = 0.0; b < 100.0; b = 3.0 * b + 0.01) {
          const glm::dvec3 seen = tone_mapped({r, g, b}, curve);
          for (int i = 0; i < 3; ++i) EXPECT_TRUE(seen[i] >= 0.0 && seen[i] <= 1.0);
        }
}

// B. Wrensch, Minimal AgX Implementation (2023), fits a polynomial to the same sigmoid; by his
// account with a mean squared error of 3.7e-6. Its error at the ends is larger: 0.0023.
TEST(ToneCurves, AgxFollowsThePublishedPolynomial) {
  double squares = 0.0;
  constexpr int kSteps = 1000;
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) / kSteps;
    const double fit = 15.5 * std::pow(x, 6) - 40.14 * std::pow(x, 5) + 31.96 * std::pow(x, 4) -
                       6.868 * std::pow(x, 3) + 0.4298 * x * x + 0.1191 * x - 0.00232;
    // Grey passes the matrices nearly unchanged: their rows sum to 1 within 2e-4.
    const double seen =
        std::pow(tone_mapped(glm::dvec3(std::exp2(x * 16.5 - 12.47393) / 0.6), ToneCurve::kAgx).y,
                 1.0 / 2.2);
    squares += (seen - fit) * (seen - fit);
    EXPECT_NEAR(seen, fit, 0.006) << x;
  }
  EXPECT_LT(squares / kSteps, 1e-5);
}

TEST(ToneCurves, AgxShowsMiddleGreyAtHalf) {
  const glm::dvec3 seen = tone_mapped(glm::dvec3(0.18 / 0.6), ToneCurve::kAgx);
  EXPECT_NEAR(std::pow(seen.y, 1.0 / 2.2), 0.5, 1e-3);
}

TEST(Display, LeavesThePictureAloneByDefault) {
  for (int i = 0; i <= 255; ++i) EXPECT_DOUBLE_EQ(render::displayed(i / 255.0, {}), i / 255.0);
}

TEST(Display, LiftsTheDarkButNeverBlack) {
  const render::DisplaySettings display{1.0f, 0.03f};
  EXPECT_EQ(render::displayed(0.0, display), 0.0);
  EXPECT_GT(render::displayed(2.0 / 255.0, display), 2.0 / 255.0 + 0.008);
  EXPECT_NEAR(render::displayed(0.7, display), 0.7, 0.012);
  EXPECT_DOUBLE_EQ(render::displayed(1.0, display), 1.0);
}

TEST(Display, RisesAllTheWayToItsPeak) {
  for (const float peak : {0.1f, 0.5f, 1.0f})
    for (const float black : {0.0f, 0.02f, 0.2f}) {
      const render::DisplaySettings display{peak, black};
      double last = render::displayed(0.0, display);
      EXPECT_EQ(last, 0.0);
      for (int i = 1; i <= 4096; ++i) {
        const double next = render::displayed(i / 4096.0, display);
        EXPECT_GT(next, last);
        last = next;
      }
      EXPECT_NEAR(last, render::srgb_encoded(peak), 1e-12);
    }
}

}  // namespace
}  // namespace skerry::reference
