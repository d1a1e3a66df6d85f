// What counts as flicker, on pictures of one pixel each.
#include "tools/measure/flicker.h"

#include <gtest/gtest.h>

#include <array>

namespace skerry::measure {
namespace {

using Pixel = std::array<std::uint8_t, 4>;

FlickerCounts count(Pixel shown_before, Pixel shown_now, Pixel ideal_before, Pixel ideal_now) {
  return count_flicker({shown_before, ideal_before}, {shown_now, ideal_now});
}

constexpr Pixel kDark{10, 10, 10, 255}, kBright{200, 10, 10, 255};

TEST(Flicker, AChangeThatTheIdealPictureHasTooIsNone) {
  EXPECT_EQ(count(kDark, kBright, kDark, kBright), (FlickerCounts{1, 1, 1, 0}));
  EXPECT_EQ(count(kDark, kDark, kBright, kBright), (FlickerCounts{1, 0, 0, 0}));
}

TEST(Flicker, AChangeTooMuchAndOneThatIsMissingBothCount) {
  EXPECT_EQ(count(kDark, kBright, kDark, kDark), (FlickerCounts{1, 1, 0, 1}));
  EXPECT_EQ(count(kDark, kDark, kDark, kBright), (FlickerCounts{1, 0, 1, 1}));
  // The other way round is no less wrong.
  EXPECT_EQ(count(kDark, kBright, kBright, kDark), (FlickerCounts{1, 1, 1, 1}));
}

TEST(Flicker, EachChannelCountsAndAlphaDoesNot) {
  const auto with = [](std::size_t channel, std::uint8_t value) {
    Pixel out{100, 100, 100, 100};
    out[channel] = value;
    return out;
  };
  for (std::size_t channel = 0; channel < 4; ++channel) {
    const Pixel grey = with(channel, 100);
    const std::uint64_t seen = channel < 3;
    EXPECT_EQ(count(grey, with(channel, 141), grey, grey), (FlickerCounts{1, seen, 0, seen}));
    EXPECT_EQ(count(grey, with(channel, 59), grey, grey), (FlickerCounts{1, seen, 0, seen}));
    EXPECT_EQ(count(grey, with(channel, 140), grey, grey), (FlickerCounts{1, 0, 0, 0}));
  }
}

TEST(Flicker, AStepIsMoreThanTwoOf255InSomeChannel) {
  const std::array<std::uint8_t, 8> before{10, 20, 30, 0, 100, 100, 100, 0};
  std::array<std::uint8_t, 8> now{12, 18, 31, 255, 100, 100, 100, 9};
  EXPECT_EQ(count_steps(before, now), (StepCounts{2, 0, 2}));
  now[5] = 103;
  EXPECT_EQ(count_steps(before, now), (StepCounts{2, 1, 3}));
  now[0] = 0;
  EXPECT_EQ(count_steps(before, now), (StepCounts{2, 2, 10}));
  EXPECT_EQ(count_steps(before, now, kUnseenChange), (StepCounts{2, 1, 10}));
}

}  // namespace
}  // namespace skerry::measure
