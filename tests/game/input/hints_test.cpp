#include "game/input/hints.h"

#include <gtest/gtest.h>

#include "tests/folder.h"

namespace skerry::game {
namespace {

using platform::Input;
using platform::Key;

void press(Hints& hints, Key key, double seconds = 0.1, bool on_foot = true) {
  Input input;
  input.set_key(key, true);
  hints.note(ActionFrame(input.take(), default_bindings()), seconds, on_foot);
}

TEST(Hints, ComeOneByOneAndGoOnceUsed) {
  Hints hints;
  const auto line = [&] { return hints.line(default_bindings(), false, true).value_or("none"); };
  EXPECT_EQ(line(), "W, A, S, D: walk");
  EXPECT_EQ(hints.line(default_bindings(), true, true),
            "Left stick up, Left stick left, Left stick down, Left stick right: walk");
  press(hints, Key::kN);  // no hint's
  EXPECT_FALSE(hints.take_changed());
  press(hints, Key::kA);
  EXPECT_TRUE(hints.take_changed());
  EXPECT_FALSE(hints.take_changed());
  EXPECT_EQ(line(), "Space: jump");
  press(hints, Key::kMouseLeft);  // before its turn
  press(hints, Key::kSpace);
  EXPECT_EQ(line(), "Right click: place what is in the hand");
  for (const Key key : {Key::kMouseRight, Key::kE, Key::kL, Key::kEscape}) press(hints, key);
  EXPECT_EQ(line(), "none");
}

TEST(Hints, GoOnceShownLongEnoughToWhoDoesOtherThings) {
  Hints hints;
  press(hints, Key::kW);
  const auto line = [&] { return hints.line(default_bindings(), false, true).value_or("none"); };
  for (int i = 0; i < 1000; ++i) hints.note({}, 1.0, true);  // nobody is there
  for (int i = 0; i < 30; ++i) press(hints, Key::kW, 1.0);
  EXPECT_EQ(line(), "Space: jump");
  press(hints, Key::kW, 1.0);
  EXPECT_EQ(line(), "Left click: dig, held");
  press(hints, Key::kMouseLeft);
  for (int i = 0; i < 30; ++i) press(hints, Key::kW, 1.0);
  EXPECT_EQ(line(), "Right click: place what is in the hand");  // each has its own time
  for (int i = 0; i < 200; ++i) press(hints, Key::kW, 1.0);
  EXPECT_EQ(line(), "none");
  EXPECT_EQ(Hints::read(hints.print()).line(default_bindings(), false, true), std::nullopt);
}

TEST(Hints, OfWalkingWaitWhileTheKeysDoOtherThings) {
  Hints hints;
  const auto line = [&](bool on_foot) {
    return hints.line(default_bindings(), false, on_foot).value_or("none");
  };
  press(hints, Key::kW);
  EXPECT_EQ(line(false), "Left click: dig, held");
  press(hints, Key::kSpace, 0.1, false);  // raises an island
  EXPECT_EQ(line(true), "Space: jump");
  // What is shown instead has a time of its own, and jumping begins anew.
  for (int i = 0; i < 20; ++i) press(hints, Key::kW, 1.0);
  for (int i = 0; i < 20; ++i) press(hints, Key::kW, 1.0, false);
  EXPECT_EQ(line(false), "Left click: dig, held");
  for (int i = 0; i < 20; ++i) press(hints, Key::kW, 1.0);
  EXPECT_EQ(line(true), "Space: jump");
  for (int i = 0; i < 200; ++i) press(hints, Key::kW, 1.0, false);
  EXPECT_EQ(line(false), "none");
  EXPECT_EQ(line(true), "Space: jump");
}

TEST(Hints, NameTheKeysThatAreBound) {
  Bindings bindings = default_bindings();
  bindings[Action::kForward].key = {Key::kUp};
  bindings[Action::kBack].key = {};
  EXPECT_EQ(Hints().line(bindings, false, true), "Arrow up, A, D: walk");
  for (const Action action : {Action::kForward, Action::kLeft, Action::kRight})
    bindings[action].key = {};
  EXPECT_EQ(Hints().line(bindings, false, true), "Space: jump");  // one without a key is skipped
}

TEST(Hints, AreKeptInAFileAndSurviveAnyOther) {
  const Folder folder;
  const auto path = folder / "deep" / "hints.json";
  Hints hints;
  press(hints, Key::kW);
  ASSERT_TRUE(save_hints(path, hints));
  EXPECT_EQ(load_hints(path).line(default_bindings(), false, true), "Space: jump");
  EXPECT_EQ(load_hints(path).print(), hints.print());
  for (const char* text : {"", "{", "[]", "7", R"({"used": 3})", R"({"used": [1, "x", null]})",
                           R"({"used": {"walk": 1}})", "\xff\xfe"})
    EXPECT_EQ(Hints::read(text).line(default_bindings(), false, true), "W, A, S, D: walk") << text;
  EXPECT_TRUE(load_hints(folder / "none.json").line(default_bindings(), false, true));
  EXPECT_FALSE(save_hints({}, hints));
}

}  // namespace
}  // namespace skerry::game
