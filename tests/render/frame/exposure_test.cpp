#include "engine/render/frame/exposure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace skerry::render {
namespace {

TEST(Exposure, TheRestOfTheWayFallsToOneEthInATimeConstant) {
  EXPECT_NEAR(adapted_ev(0.0, 8.0, kLightAdaptationSeconds), 8.0 - 8.0 / M_E, 1e-14);
  EXPECT_NEAR(adapted_ev(0.0, -8.0, kDarkAdaptationSeconds), 8.0 / M_E - 8.0, 1e-14);
}

TEST(Exposure, NoTimeChangesNothingAndLongArrives) {
  for (const double target : {-20.0, -0.3, 1e-300, 17.1}) {
    EXPECT_EQ(adapted_ev(1.7, target, 0.0), 1.7);
    EXPECT_EQ(adapted_ev(1.7, target, 1e6), target);
    EXPECT_EQ(adapted_ev(target, target, 0.1), target);
  }
}

TEST(Exposure, LightIsFasterThanDark) {
  EXPECT_GT(adapted_ev(0.0, 10.0, 0.1), -adapted_ev(0.0, -10.0, 0.1));
}

TEST(Exposure, SplittingTheTimeChangesNothingButRounding) {
  const double whole = adapted_ev(-7.0, 0.5, 1.0);
  double split = -7.0;
  for (int i = 0; i < 1000; ++i) split = adapted_ev(split, 0.5, 1e-3);
  // A thousand roundings of numbers up to 7.5, each half a unit in the last place (2^-51).
  EXPECT_NEAR(split, whole, 1000 * std::ldexp(1.0, -51));
}

TEST(Exposure, StaysWhenNothingWasMetered) {
  for (const double target : {std::nan(""), std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()})
    EXPECT_EQ(adapted_ev(-2.5, target, 1.0), -2.5);
}

TEST(ExposureDeathTest, TimeDoesNotRunBackwards) {
  EXPECT_DEATH(adapted_ev(0.0, 1.0, -1e-9), "dt_s");
  EXPECT_DEATH(adapted_ev(0.0, 1.0, std::nan("")), "dt_s");
}

}  // namespace
}  // namespace skerry::render
