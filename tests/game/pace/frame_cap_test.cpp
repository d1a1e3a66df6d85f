#include "game/pace/frame_cap.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "game/scene_file/settings.h"

namespace skerry::game {
namespace {

TEST(FrameCap, TheLowerOfCapAndFocusHolds) {
  constexpr double kOff = FrameSettings::kNoCap, kDisplay = FrameSettings::kDisplayCap;
  EXPECT_EQ(capped_rate(kOff, 75.0, true, 10.0), 0.0);
  EXPECT_EQ(capped_rate(kDisplay, 75.0, true, 10.0), 75.0);
  EXPECT_EQ(capped_rate(40.0, 75.0, true, 10.0), 40.0);
  EXPECT_EQ(capped_rate(kOff, 75.0, false, 10.0), 10.0);
  EXPECT_EQ(capped_rate(5.0, 75.0, false, 10.0), 5.0);
}

TEST(FrameCap, RatesHoldOnAverageThoughSleepsAreTooLong) {
  double due_s = 0.0, now_s = 0.0;
  for (int i = 0; i < 1000; ++i) {
    due_s = next_due(due_s, now_s, 50.0);
    EXPECT_GE(due_s, now_s - 0.02);
    now_s = std::max(now_s, due_s) + 0.004;  // sleeps and the frame itself
  }
  EXPECT_NEAR(now_s, 20.0, 0.03);
}

TEST(FrameCap, NoBurstFollowsALateFrame) {
  EXPECT_EQ(next_due(1.0, 3.0, 50.0), 3.0);
  EXPECT_EQ(next_due(3.0, 3.001, 50.0), 3.02);
}

TEST(FrameCap, WithoutACapAFrameIsDueAtOnce) {
  EXPECT_EQ(next_due(1.0, 1.5, 0.0), 1.5);
}

}  // namespace
}  // namespace skerry::game
