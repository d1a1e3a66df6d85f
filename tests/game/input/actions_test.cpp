#include "game/input/actions.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <set>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "game/input/controls.h"
#include "game/words/words.h"
#include "tests/folder.h"

namespace skerry::game {
namespace {

using platform::Input;
using platform::Key;
using platform::PadState;

PadState resting_pad() {
  return {{}, {0.0f, 0.0f, 0.0f, 0.0f, -1.0f, -1.0f}};
}

ActionFrame actions_of(Input& input, const Bindings& bindings = default_bindings()) {
  return {input.take(), bindings};
}

TEST(Actions, NamesAreUniqueAndComeBack) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kActions; ++i) {
    const auto action = static_cast<Action>(i);
    EXPECT_TRUE(names.insert(action_type(action).name).second);
    EXPECT_EQ(action_named(action_type(action).name), action);
  }
  EXPECT_FALSE(action_named("dance"));
}

TEST(Actions, EveryKeyHasANameThatComesBack) {
  for (int i = 0; i < static_cast<int>(Key::kCount); ++i) {
    const auto key = static_cast<Key>(i);
    EXPECT_EQ(platform::key_named(platform::key_name(key)), key);
  }
}

TEST(Actions, NoTwoAreBoundToTheSameByDefault) {
  for (std::size_t i = 0; i < kActions; ++i)
    EXPECT_TRUE(conflicts_of(default_bindings(), static_cast<Action>(i)).empty())
        << action_type(static_cast<Action>(i)).name;
}

TEST(Actions, ConflictsAreFoundBothWays) {
  Bindings bindings = default_bindings();
  bindings[Action::kJump].key = {Key::kW};
  EXPECT_EQ(conflicts_of(bindings, Action::kJump), std::vector{Action::kForward});
  EXPECT_EQ(conflicts_of(bindings, Action::kForward), std::vector{Action::kJump});
  bindings[Action::kJump].key = {Key::kW, true};  // with Ctrl it is another chord
  EXPECT_TRUE(conflicts_of(bindings, Action::kForward).empty());
}

TEST(Actions, ControlMakesAChordAndSilencesThePlainKey) {
  Input input;
  input.set_key(Key::kY, true);
  const ActionFrame plain = actions_of(input);
  EXPECT_TRUE(plain.pressed(Action::kEarlier) && !plain.pressed(Action::kRedo));
  input.set_key(Key::kY, false);
  (void)input.take();
  input.set_key(Key::kControl, true);
  input.set_key(Key::kY, true);
  input.set_key(Key::kW, true);
  const ActionFrame both = actions_of(input);
  EXPECT_TRUE(both.pressed(Action::kRedo) && !both.down(Action::kEarlier));
  EXPECT_TRUE(both.down(Action::kForward));  // nothing is bound to Ctrl and W
}

TEST(Actions, AGamepadsBackMakesChordsAsControlDoes) {
  Input input;
  PadState pad = resting_pad();
  pad.buttons.set(3);  // Y
  input.set_pad(pad);
  const ActionFrame plain = actions_of(input);
  EXPECT_TRUE(plain.pressed(Action::kFly) && !plain.pressed(Action::kNoclip));
  pad.buttons.reset(3);
  pad.buttons.set(6);  // Back
  input.set_pad(pad);
  (void)input.take();
  pad.buttons.set(3);
  pad.axes[1] = -1.0f;
  input.set_pad(pad);
  const ActionFrame both = actions_of(input);
  EXPECT_TRUE(both.pressed(Action::kNoclip) && !both.pressed(Action::kFly));
  EXPECT_TRUE(both.down(Action::kForward));  // nothing is bound to Back and the stick
}

TEST(Actions, KeysAreNamedInThePlayersLanguageAndNoTwoAlike) {
  EXPECT_EQ(chord_label({Key::kZ, true}), "Ctrl+Z");
  EXPECT_EQ(chord_label({Key::kPadY, true}), "Back button+Y");
  EXPECT_EQ(chord_label({}), "-");
  for (std::size_t language = 0; language < kLanguages; ++language) {
    speak(static_cast<Language>(language));
    std::set<std::string> keys, buttons;
    for (std::size_t i = 1; i < static_cast<std::size_t>(Key::kCount); ++i) {
      const Chord chord{static_cast<Key>(i)};
      auto& labels = platform::is_pad(chord.key) ? buttons : keys;
      EXPECT_TRUE(labels.insert(chord_label(chord)).second) << chord_label(chord);
    }
  }
  speak(Language::kGerman);
  EXPECT_EQ(chord_label({Key::kZ, true}), "Strg+Z");
  EXPECT_EQ(chord_label({Key::kMouse5}), "Maus 5");
  speak(Language::kEnglish);
}

TEST(Actions, ChordsAreOfOneDevice) {
  EXPECT_EQ(parse_chord("pad_back+pad_y"), (Chord{Key::kPadY, true}));
  EXPECT_EQ(parse_chord("pad_back"), Chord{Key::kPadBack});
  for (const char* text :
       {"pad_back+y", "ctrl+pad_y", "pad_back+pad_back", "ctrl+ctrl", "ctrl+", "pad_back+none"})
    EXPECT_FALSE(parse_chord(text)) << text;
  for (std::size_t i = 0; i < kActions; ++i) {
    const Binding binding = default_bindings()[static_cast<Action>(i)];
    EXPECT_EQ(parse_chord(print_chord(binding.key)), binding.key);
    EXPECT_EQ(parse_chord(print_chord(binding.pad)), binding.pad);
  }
}

TEST(Actions, EscapeAndStartPauseUnlessTheyMeanSomethingElse) {
  const auto pauses = [](const Bindings& bindings, bool on_pad) {
    Input input;
    PadState pad = resting_pad();
    pad.buttons[7] = on_pad;  // Start
    input.set_pad(pad);
    input.set_key(Key::kEscape, !on_pad);
    return actions_of(input, bindings).pressed(Action::kPause);
  };
  Bindings bindings = default_bindings();
  EXPECT_TRUE(pauses(bindings, false) && pauses(bindings, true));
  bindings[Action::kPause] = {};
  EXPECT_TRUE(pauses(bindings, false) && pauses(bindings, true));
  bindings[Action::kTorch] = {{Key::kEscape}, {Key::kPadStart}};
  EXPECT_FALSE(pauses(bindings, false) || pauses(bindings, true));
}

TEST(Actions, AKeyLetGoOfIsReleasedWhateverControlDoes) {
  Input input;
  input.set_key(Key::kY, true);
  (void)input.take();
  input.set_key(Key::kControl, true);
  input.set_key(Key::kY, false);
  const ActionFrame frame = actions_of(input);
  EXPECT_TRUE(frame.released(Action::kEarlier) && !frame.down(Action::kEarlier));
}

TEST(Actions, AWheelCountsItsNotches) {
  Input input;
  input.add_scroll(-3.0);
  const ActionFrame frame = actions_of(input);
  EXPECT_EQ(frame.presses(Action::kNextSlot), 3);
  EXPECT_EQ(frame.presses(Action::kPreviousSlot), 0);
  EXPECT_EQ(actions_of(input).presses(Action::kNextSlot), 0);
}

TEST(Actions, ASticksWayIsAnalogBeyondItsDeadZone) {
  Input input;
  PadState pad = resting_pad();
  pad.axes[1] = -1.0f;  // forward
  pad.axes[0] = 0.1f;   // a worn stick
  input.set_pad(pad);
  const ActionFrame full = actions_of(input);
  EXPECT_EQ(full.value(Action::kForward), 1.0);
  EXPECT_EQ(full.value(Action::kRight), 0.0);
  EXPECT_TRUE(full.pressed(Action::kForward));
  pad.axes[1] = -0.59f;  // half way beyond 0.18
  input.set_pad(pad);
  EXPECT_NEAR(actions_of(input).value(Action::kForward), 0.5, 1e-6);
}

TEST(Actions, AStickHeldAtTheEdgeDoesNotChatter) {
  Input input;
  PadState pad = resting_pad();
  int presses = 0;
  for (int i = 0; i < 100; ++i) {
    pad.axes[4] = i % 2 == 0 ? 0.2f : 0.16f;  // a trigger trembles about the middle of its way
    input.set_pad(pad);
    presses += actions_of(input).presses(Action::kPlace);
  }
  EXPECT_EQ(presses, 1);
}

TEST(Actions, AGamepadUnpluggedWhileHeldLetsGoOfEverything) {
  Input input;
  PadState pad = resting_pad();
  pad.buttons.set(0);   // A: jump
  pad.axes[1] = -1.0f;  // forward
  pad.axes[5] = 1.0f;   // dig
  input.set_pad(pad);
  input.set_key(Key::kD, true);
  const ActionFrame held = actions_of(input);
  EXPECT_TRUE(held.down(Action::kJump) && held.down(Action::kDig));
  input.set_pad(std::nullopt);
  const ActionFrame after = actions_of(input);
  for (const Action action : {Action::kJump, Action::kDig, Action::kForward}) {
    EXPECT_FALSE(after.down(action));
    EXPECT_TRUE(after.released(action));
    EXPECT_EQ(after.value(action), 0.0);
  }
  EXPECT_TRUE(after.down(Action::kRight));  // the keyboard is still there
}

TEST(Actions, LosingTheFocusLetsGoOfKeysAndSticks) {
  Input input;
  PadState pad = resting_pad();
  pad.axes[1] = -1.0f;
  input.set_pad(pad);
  input.set_key(Key::kD, true);
  (void)input.take();
  input.lose_focus();
  const ActionFrame after = actions_of(input);
  EXPECT_EQ(intent_of(after).move, glm::dvec2(0.0));
  EXPECT_FALSE(after.down(Action::kForward) || after.down(Action::kRight));
}

TEST(Actions, ADriversNonsenseIsRest) {
  Input input;
  PadState pad = resting_pad();
  pad.axes.fill(std::numeric_limits<float>::quiet_NaN());
  input.set_pad(pad);
  const ActionFrame frame = actions_of(input);
  for (std::size_t i = 0; i < kActions; ++i)
    EXPECT_EQ(frame.value(static_cast<Action>(i)), 0.0) << i;
}

TEST(Bindings, ComeBackFromAFile) {
  const Folder folder;
  Bindings bindings = default_bindings();
  bindings[Action::kUndo].key = {Key::kBackspace, true};
  bindings[Action::kJump] = {{}, {Key::kPadX}};
  bindings.mouse_speed = 0.35;
  bindings.inverted = true;
  const auto path = folder / "deep" / "controls.json";
  const auto saved = save_bindings(path, bindings);
  ASSERT_TRUE(saved) << saved.error().message;
  const ReadBindings read = load_bindings(path);
  EXPECT_TRUE(read.problems.empty());
  EXPECT_EQ(read.bindings, bindings);
}

TEST(Bindings, AFileThatIsNotThereIsNoProblem) {
  const Folder folder;
  const ReadBindings read = load_bindings(folder / "none.json");
  EXPECT_TRUE(read.problems.empty());
  EXPECT_EQ(read.bindings, default_bindings());
}

TEST(Bindings, NonsenseIsToldInOneLineEachAndTheRestHolds) {
  const char* const files[] = {"",
                               "{",
                               "[]",
                               "7",
                               R"({"actions": 3})",
                               R"({"actions": {"jump": "w"}})",
                               R"({"actions": {"jump": {"key": 5}}})",
                               R"({"actions": {"jump": {"key": "anykey"}}})",
                               R"({"actions": {"jump": {"key": "pad_a"}}})",
                               R"({"actions": {"jump": {"pad": "w"}}})",
                               R"({"actions": {"jump": {"key": "ctrl+none"}}})",
                               R"({"actions": {"dance": {"key": "w"}}})",
                               R"({"mouse_speed": "fast"})",
                               R"({"mouse_speed": 1e9})",
                               R"({"pad_speed": null})",
                               R"({"inverted": 1})",
                               "\xff\xfe"};
  for (const char* text : files) {
    const ReadBindings read = read_bindings(text);
    ASSERT_EQ(read.problems.size(), 1u) << text;
    EXPECT_EQ(read.problems[0].find('\n'), std::string::npos) << text;
    EXPECT_EQ(read.bindings, default_bindings()) << text;
  }
  const ReadBindings half =
      read_bindings(R"({"actions": {"jump": {"key": "j"}, "dig": {"key": []}}, "inverted": true})");
  EXPECT_EQ(half.problems.size(), 1u);
  EXPECT_EQ(half.bindings[Action::kJump].key, Chord{Key::kJ});
  EXPECT_EQ(half.bindings[Action::kDig], default_bindings()[Action::kDig]);
  EXPECT_TRUE(half.bindings.inverted);
}

TEST(Bindings, AHostileFileDoesNotFillTheScreen) {
  std::string text = R"({"actions": {)";
  for (int i = 0; i < 10000; ++i) text += (i ? ",\"x" : "\"x") + std::to_string(i) + "\": 0";
  EXPECT_LE(read_bindings(text + "}}").problems.size(), 8u);
}

TEST(Bindings, SavingOverAFileThatWasNotUnderstoodKeepsIt) {
  const Folder folder;
  const auto path = folder / "controls.json";
  ASSERT_TRUE(write_text(path, "{my bindings"));
  ASSERT_TRUE(save_bindings(path, default_bindings()));
  EXPECT_EQ(*platform::read_text(folder / "controls.json.old", 100), "{my bindings");
  EXPECT_TRUE(load_bindings(path).problems.empty());
}

TEST(Bindings, AFolderThatCannotBeWrittenIsToldInOneLine) {
  const Folder folder;
  ASSERT_TRUE(write_text(folder / "file", ""));
  for (const auto& path : {std::filesystem::path{}, folder / "file" / "controls.json"}) {
    const auto saved = save_bindings(path, default_bindings());
    ASSERT_FALSE(saved);
    EXPECT_EQ(saved.error().message.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace skerry::game
