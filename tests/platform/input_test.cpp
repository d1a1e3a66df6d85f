#include "engine/platform/input.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/platform/window.h"

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

TEST(Input, EventsKeepTheirOrderAndThePointersPlace) {
  Input input;
  input.set_key(Key::kControl, true);
  (void)input.take();
  input.move_pointer({5.0, 6.0});
  input.set_key(Key::kMouseLeft, true);
  input.type(U'\u044f');
  input.set_key(Key::kControl, false);
  input.add_scroll(-2.0);
  input.move_pointer({50.0, 60.0});
  const InputFrame frame = input.take();
  EXPECT_TRUE(frame.was_down(Key::kControl) && !frame.down(Key::kControl));
  ASSERT_EQ(frame.events.size(), 4u);
  EXPECT_EQ(frame.events[0].key, Key::kMouseLeft);
  EXPECT_EQ(frame.events[0].pointer, glm::dvec2(5.0, 6.0));
  EXPECT_EQ(frame.pointer, glm::dvec2(50.0, 60.0));
  EXPECT_EQ(frame.events[1].character, U'\u044f');
  EXPECT_TRUE(frame.events[2].key == Key::kControl && !frame.events[2].down);
  EXPECT_TRUE(frame.events[3].key == Key::kWheelDown && frame.events[3].amount == 2.0f);
  EXPECT_TRUE(input.take().events.empty());
}

TEST(Input, MoreEventsThanAreKeptLeaveNothingHeld) {
  Input input;
  for (int i = 0; i < 5000; ++i)
    for (const bool down : {true, false}) input.set_key(Key::kW, down);
  const InputFrame frame = input.take();
  EXPECT_EQ(frame.events.size(), InputFrame::kMaxEvents);
  EXPECT_FALSE(frame.down(Key::kW));
}

TEST(WindowEvents, APointerThatAWindowsChangePutsElsewhereIsNoMotion) {
  WindowEvents events;
  double now_s = 10.0;
  const auto poll = [&](std::initializer_list<glm::dvec2> places) {
    for (const glm::dvec2 place : places) events.move_pointer(place, now_s);
    events.end_poll(now_s);
    now_s += 0.2;  // a slow machine
    return events.input.take().mouse_delta;
  };
  (void)poll({{100.0, 100.0}});
  EXPECT_EQ(poll({{110.0, 105.0}}), glm::dvec2(10.0, 5.0));
  (void)poll({});
  (void)poll({});
  events.disturb(now_s);
  EXPECT_EQ(poll({{640.0, 360.0}}), glm::dvec2(0.0));
  EXPECT_EQ(poll({{1.0, 1.0}}), glm::dvec2(0.0));  // what was warped after the change was seen
  EXPECT_EQ(poll({{4.0, 2.0}}), glm::dvec2(3.0, 1.0));
  (void)poll({});
  (void)poll({});
  events.disturb(now_s);
  for (int i = 0; i < 5; ++i, now_s += 0.01) {  // a fast one
    events.move_pointer({100.0 * i, 0.0}, now_s);
    events.end_poll(now_s);
  }
  EXPECT_EQ(events.input.take().mouse_delta, glm::dvec2(0.0));
  // A constraint's event may come first, in this poll or in the one before: it is taken back.
  now_s += 1.0;
  EXPECT_EQ(poll({{410.0, 0.0}}), glm::dvec2(10.0, 0.0));
  now_s += 1.0;
  (void)poll({});
  EXPECT_EQ(poll({{64.0, 68.0}}), glm::dvec2(-346.0, 68.0));
  events.move_pointer({60.0, 60.0}, now_s);
  events.disturb(now_s);
  EXPECT_EQ(poll({{63.0, 63.0}}), glm::dvec2(346.0, -68.0));
}

TEST(WindowEvents, WhatTheMouseDoesWhileNothingCanActOnItCountsAsNothingAndKeysAreKept) {
  WindowEvents events;
  events.move_pointer({100.0, 100.0}, 10.0);
  events.end_poll(10.0);
  (void)events.input.take();
  events.move_pointer({400.0, 90.0}, 11.0);
  events.input.add_scroll(3.0);
  for (const bool down : {true, false}) events.input.set_key(Key::kMouseRight, down);
  events.input.set_key(Key::kMouseLeft, true);
  for (const bool down : {true, false}) events.input.set_key(Key::kEscape, down);
  events.input.set_key(Key::kW, true);
  events.input.type('x');
  events.drop_mouse();
  events.disturb(11.5);  // takes back nothing that was dropped
  events.end_poll(11.5);
  const InputFrame frame = events.input.take();
  EXPECT_EQ(frame.mouse_delta, glm::dvec2(0.0));
  EXPECT_EQ(frame.scroll, 0.0);
  EXPECT_EQ(frame.pointer, glm::dvec2(400.0, 90.0));
  for (const Key key : {Key::kMouseLeft, Key::kMouseRight, Key::kWheelUp}) {
    EXPECT_FALSE(frame.pressed(key));
    EXPECT_EQ(frame.presses(key), 0);
  }
  EXPECT_TRUE(frame.down(Key::kMouseLeft));
  EXPECT_TRUE(frame.was_down(Key::kMouseLeft));
  EXPECT_EQ(frame.presses(Key::kEscape), 1);
  EXPECT_TRUE(frame.pressed(Key::kW));
  EXPECT_TRUE(frame.down(Key::kW));
  EXPECT_EQ(frame.events.back().character, U'x');
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
  EXPECT_TRUE(std::none_of(opened.events.begin(), opened.events.end(),
                           [](const InputEvent& event) { return event.key == Key::kNone; }));
  input.set_key(Key::kE, false);
  EXPECT_FALSE(held_back.filtered(input.take()).released(Key::kE));
  input.set_key(Key::kE, true);
  EXPECT_TRUE(held_back.filtered(input.take()).pressed(Key::kE));
}

}  // namespace
}  // namespace skerry::platform
