#include "engine/platform/input.h"

#include <gtest/gtest.h>

namespace skerry::platform {
namespace {

TEST(Input, APressIsSeenOnceAndHeldUntilReleased) {
  Input input;
  input.set_key(Key::kW, true);
  const InputFrame first = input.take();
  EXPECT_TRUE(first.down(Key::kW) && first.pressed(Key::kW) && !first.released(Key::kW));
  input.set_key(Key::kW, true);  // key repeat
  const InputFrame second = input.take();
  EXPECT_TRUE(second.down(Key::kW) && !second.pressed(Key::kW));
  input.set_key(Key::kW, false);
  const InputFrame third = input.take();
  EXPECT_TRUE(!third.down(Key::kW) && third.released(Key::kW));
  EXPECT_FALSE(input.take().released(Key::kW));
}

TEST(Input, AKeyTappedWithinOneFrameIsNotLost) {
  Input input;
  input.set_key(Key::kF2, true);
  input.set_key(Key::kF2, false);
  const InputFrame frame = input.take();
  EXPECT_TRUE(frame.pressed(Key::kF2) && frame.released(Key::kF2) && !frame.down(Key::kF2));
}

TEST(Input, LosingTheFocusReleasesEverything) {
  Input input;
  input.set_key(Key::kW, true);
  input.set_key(Key::kSpace, true);
  (void)input.take();
  input.lose_focus();
  const InputFrame frame = input.take();
  for (const Key key : {Key::kW, Key::kSpace}) EXPECT_TRUE(!frame.down(key) && frame.released(key));
}

TEST(Input, PointerMotionAddsUpAndJumpsDoNotCount) {
  Input input;
  input.move_pointer({100.0, 100.0});
  EXPECT_EQ(input.take().mouse_delta, glm::dvec2(0.0));
  input.move_pointer({103.0, 99.0});
  input.move_pointer({104.0, 95.0});
  EXPECT_EQ(input.take().mouse_delta, glm::dvec2(4.0, -5.0));
  input.reset_pointer();
  input.move_pointer({500.0, 500.0});
  EXPECT_EQ(input.take().mouse_delta, glm::dvec2(0.0));
  input.add_scroll(1.0);
  input.add_scroll(-3.0);
  EXPECT_EQ(input.take().scroll, -2.0);
  EXPECT_EQ(input.take().scroll, 0.0);
}

TEST(HeldBack, WhatWasHeldMeansNothingUntilItHasGoneUp) {
  Input input;
  HeldBack held_back;
  input.set_key(Key::kE, true);
  input.type(U'e');
  held_back.hold(input.take());
  input.type(U'e');  // key repeat
  input.set_key(Key::kW, true);
  const InputFrame opened = held_back.filtered(input.take());
  EXPECT_FALSE(opened.down(Key::kE) || opened.pressed(Key::kE));
  EXPECT_TRUE(opened.pressed(Key::kW));
  EXPECT_TRUE(opened.text.empty());
  input.set_key(Key::kE, false);
  EXPECT_FALSE(held_back.filtered(input.take()).released(Key::kE));
  input.set_key(Key::kE, true);
  EXPECT_TRUE(held_back.filtered(input.take()).pressed(Key::kE));
}

}  // namespace
}  // namespace skerry::platform
