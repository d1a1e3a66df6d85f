#include "game/input/controls.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <vector>

namespace skerry::game {
namespace {

using platform::Input;
using platform::Key;

Intent intent_after(Input& input) {
  return intent_of(ActionFrame(input.take(), default_bindings()));
}

TEST(Controls, CalibrationGoesInStepsThereAndBackAndEnds) {
  const render::DisplaySettings before{};
  EXPECT_EQ(stepped_display(before, 0, 0), before);
  render::DisplaySettings display = stepped_display(before, -3, 5);
  EXPECT_FLOAT_EQ(display.peak, 0.85f);
  EXPECT_FLOAT_EQ(display.black, 0.025f);
  EXPECT_EQ(stepped_display(display, 3, -5), before);
  EXPECT_FLOAT_EQ(stepped_display(before, -100, 100).peak, 0.1f);
  EXPECT_FLOAT_EQ(stepped_display(before, -100, 100).black, 0.2f);
  EXPECT_EQ(stepped_display(before, 100, -100), before);
}

TEST(Controls, OppositeKeysCancel) {
  Input input;
  for (const Key key : {Key::kW, Key::kS, Key::kD}) input.set_key(key, true);
  EXPECT_EQ(intent_after(input).move, glm::dvec2(1.0, 0.0));
}

TEST(Controls, AJumpTappedBetweenFramesStillJumps) {
  Input input;
  input.set_key(Key::kSpace, true);
  input.set_key(Key::kSpace, false);
  EXPECT_TRUE(intent_after(input).jump);
  EXPECT_FALSE(intent_after(input).jump);
}

class Air : public Surroundings {
  void islands_near(world::WorldPos, double, double,
                    std::vector<std::uint64_t>& out) const override {
    out.clear();
  }
  std::optional<world::Pose> pose(std::uint64_t, double) const override { return std::nullopt; }
  std::optional<world::BlockId> block(std::uint64_t, world::IVec3) const override {
    return std::nullopt;
  }
};

/// Blocks that a key moves a player who flies freely, in so many frames of so many seconds each.
double moved_by(const std::vector<bool>& events, double seconds, int frames) {
  const Air air;
  Player player({}, 0.0, 0.0, 0.0);
  player.set_mode(MoveMode::kNoclip);
  Input input;
  for (const bool down : events) input.set_key(Key::kW, down);
  for (int i = 0; i < frames; ++i)
    player.advance(seconds, intent_of(ActionFrame(input.take(), default_bindings(), seconds)), air);
  return glm::length(world::difference_blocks(player.feet(), {}));
}

TEST(Controls, ATapBetweenTwoFramesMovesAsFarAsATenthOfASecondAtMost) {
  const double tenth = 0.1 * moved_by({true}, 0.5, 20) / 10.0;  // at the speed that it gets to
  ASSERT_GT(tenth, 0.1);
  for (const double seconds : {0.1, 0.2, 0.5, 1.0}) {
    const double tapped = moved_by({true, false}, seconds, 1);
    EXPECT_GT(tapped, 0.3 * tenth) << seconds;
    EXPECT_LT(tapped, 1.05 * tenth) << seconds;
    EXPECT_GT(moved_by({true, false, true, false}, seconds, 1), tapped * 0.99) << seconds;
  }
  // Never more than the key held, and nothing of it is left for the next frame.
  EXPECT_LE(moved_by({true, false}, 0.01, 1), moved_by({true}, 0.01, 1));
  Input input;
  for (const bool down : {true, false}) input.set_key(Key::kW, down);
  const auto forward = [&] {
    return ActionFrame(input.take(), default_bindings(), 0.4).value(Action::kForward);
  };
  EXPECT_DOUBLE_EQ(forward(), 0.25);
  EXPECT_EQ(forward(), 0.0);
}

TEST(Controls, SprintAndCrouchByAPressStayOnUntilTheNext) {
  Input input;
  Toggles toggles;
  PlaySettings settings{true, true, true};
  const auto frame = [&](bool walking = true) {
    const ActionFrame actions(input.take(), default_bindings());
    Intent intent = intent_of(actions);
    toggles.apply(settings, actions, walking, intent);
    return intent;
  };
  const auto tap = [&](Key key) {
    input.set_key(key, true);
    input.set_key(key, false);
  };
  input.set_key(Key::kW, true);
  tap(Key::kControl);
  EXPECT_TRUE(frame().fast);
  EXPECT_TRUE(frame().fast);
  tap(Key::kControl);
  EXPECT_FALSE(frame().fast);
  tap(Key::kControl);
  EXPECT_TRUE(frame().fast);
  input.set_key(Key::kW, false);  // standing still ends it
  EXPECT_FALSE(frame().fast);
  input.set_key(Key::kW, true);
  EXPECT_FALSE(frame().fast);
  tap(Key::kShift);
  EXPECT_TRUE(frame().crouch);
  EXPECT_TRUE(frame().crouch);
  EXPECT_FALSE(frame(false).crouch);  // flying, the key sinks while it is held
  EXPECT_FALSE(frame().crouch);
  input.set_key(Key::kShift, true);
  EXPECT_LT(frame(false).rise, 0.0);
  input.set_key(Key::kShift, false);
  settings = {};
  input.set_key(Key::kControl, true);
  EXPECT_TRUE(frame().fast);
  input.set_key(Key::kControl, false);
  EXPECT_FALSE(frame().fast);
}

TEST(Controls, HandsDigPlaceChooseAndTakeBack) {
  Input input;
  const auto hands = [&] { return hand_intent_of(ActionFrame(input.take(), default_bindings())); };
  input.set_key(Key::kMouseLeft, true);
  EXPECT_TRUE(hands().dig);
  EXPECT_TRUE(hands().dig);  // held
  input.set_key(Key::kMouseLeft, false);
  EXPECT_FALSE(hands().dig);
  // A click within one frame still places.
  input.set_key(Key::kMouseRight, true);
  input.set_key(Key::kMouseRight, false);
  EXPECT_TRUE(hands().place);
  EXPECT_FALSE(hands().place);
  input.set_key(Key::k7, true);
  EXPECT_EQ(hands().slot, 6);
  EXPECT_FALSE(hands().slot);
  input.add_scroll(-2.0);
  EXPECT_EQ(hands().scroll, 2);
  input.set_key(Key::kZ, true);
  EXPECT_FALSE(hands().undo);
  input.set_key(Key::kZ, false);
  input.set_key(Key::kControl, true);
  input.set_key(Key::kZ, true);
  EXPECT_TRUE(hands().undo);
  EXPECT_FALSE(hands().undo);  // once
  // Ctrl that was down before, and goes up in the frame that sees the key: the chord still counts.
  for (const bool down : {true, false}) input.set_key(Key::kY, down);
  input.set_key(Key::kControl, false);
  EXPECT_TRUE(hands().redo);
}

TEST(Controls, ChordsAreToldByTheOrderOfTheirKeysWithinAFrame) {
  Input input;
  const auto tap = [&](Key key) {
    for (const bool down : {true, false}) input.set_key(key, down);
  };
  const auto actions = [&] { return ActionFrame(input.take(), default_bindings()); };
  tap(Key::kY);
  tap(Key::kControl);
  const ActionFrame apart = actions();
  EXPECT_TRUE(apart.pressed(Action::kEarlier) && !apart.pressed(Action::kRedo));
  input.set_key(Key::kControl, true);
  for (int i = 0; i < 3; ++i) tap(Key::kZ);
  input.set_key(Key::kControl, false);
  tap(Key::kMinus);
  tap(Key::kMinus);
  const ActionFrame chords = actions();
  EXPECT_EQ(chords.presses(Action::kUndo), 3);
  EXPECT_EQ(chords.presses(Action::kWorseQuality), 2);
}

TEST(Controls, ShiftCrouches) {
  Input input;
  input.set_key(Key::kShift, true);
  EXPECT_TRUE(intent_after(input).crouch);
}

TEST(Controls, ThePointerTurnsTheHeadTheWayItMoves) {
  Player player({}, 0.0, 0.0, 0.0);
  Input input;
  input.move_pointer({0.0, 0.0});
  input.move_pointer({10.0, 20.0});  // right and down
  const Bindings bindings = default_bindings();
  const platform::InputFrame frame = input.take();
  const ActionFrame actions(frame, bindings);
  look(player, {&actions, &bindings, frame.mouse_delta, 0.01}, 70.0);
  const Air nothing;
  EXPECT_LT(player.eye(nothing).yaw_deg, 0.0);    // right of south is west: yaw falls
  EXPECT_LT(player.eye(nothing).pitch_deg, 0.0);  // down
}

TEST(Controls, UpLooksDownWhereThatIsWantedAndSidesStay) {
  Input input;
  input.move_pointer({0.0, 0.0});
  input.move_pointer({10.0, 20.0});
  Bindings bindings = default_bindings();
  const platform::InputFrame frame = input.take();
  const ActionFrame actions(frame, bindings);
  const auto turned = [&] {
    return turned_deg({&actions, &bindings, frame.mouse_delta, 0.01}, 70.0);
  };
  const glm::dvec2 usual = turned();
  bindings.inverted = true;
  EXPECT_EQ(turned(), glm::dvec2(usual.x, -usual.y));
  EXPECT_LT(usual.y, 0.0);
}

TEST(Controls, ViewDistanceStepsStayInRangeAndComeBack) {
  EXPECT_EQ(stepped_view_distance(1000, 1), 1250u);
  EXPECT_EQ(stepped_view_distance(1250, -1), 1000u);
  EXPECT_EQ(stepped_view_distance(40, -9), kMinViewDistance);
  EXPECT_EQ(stepped_view_distance(16000, 9), kMaxViewDistance);
  EXPECT_GT(stepped_view_distance(kMinViewDistance, 1), kMinViewDistance);
}

TEST(Controls, QualityStepsStopAtTheEnds) {
  EXPECT_EQ(stepped_quality(Quality::kLow, -1), Quality::kLow);
  EXPECT_EQ(stepped_quality(Quality::kLow, 1), Quality::kMedium);
  EXPECT_EQ(stepped_quality(Quality::kUltra, 1), Quality::kUltra);
}

TEST(DayClock, ShowsTheGivenTimeUntilTurnedThenWholeStepsAroundMidnight) {
  DayClock clock(86399);
  clock.turn(1.5);
  EXPECT_EQ(clock.time_of_day_s(), 0);
  clock.turn(-2.0);
  EXPECT_EQ(clock.time_of_day_s(), 86398);
  DayClock still(45296);
  EXPECT_EQ(still.time_of_day_s(), 45296);
  still.turn(0.5);
  EXPECT_EQ(still.time_of_day_s(), 45296);
  for (int i = 0; i < 630; ++i) still.turn(1.0 / 6.0);
  EXPECT_EQ(still.time_of_day_s(), 45401);  // 105.5 s
}

}  // namespace
}  // namespace skerry::game
