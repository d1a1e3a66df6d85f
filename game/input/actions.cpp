#include "game/input/actions.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>

#include "game/words/words.h"

namespace skerry::game {
namespace {

using platform::InputFrame;
using platform::Key;

constexpr ActionType kTypes[] = {
    {"forward", word("Forward"), "w", "pad_left_stick_up"},
    {"back", word("Backward"), "s", "pad_left_stick_down"},
    {"left", word("Left"), "a", "pad_left_stick_left"},
    {"right", word("Right"), "d", "pad_left_stick_right"},
    {"jump", word("Jump, rise"), "space", "pad_a"},
    {"crouch", word("Crouch, sink"), "shift", "pad_b"},
    {"fast", word("Sprint"), "ctrl", "pad_left_thumb"},
    {"fly", word("Fly or walk"), "f", "pad_y"},
    {"noclip", word("Fly through walls"), "n", "pad_back+pad_y"},
    {"faster_flight", word("Faster flight"), "ctrl+wheel_up", "pad_back+pad_right_bumper"},
    {"slower_flight", word("Slower flight"), "ctrl+wheel_down", "pad_back+pad_left_bumper"},
    {"look_up", word("Look up"), "none", "pad_right_stick_up"},
    {"look_down", word("Look down"), "none", "pad_right_stick_down"},
    {"look_left", word("Look left"), "none", "pad_right_stick_left"},
    {"look_right", word("Look right"), "none", "pad_right_stick_right"},
    {"dig", word("Dig"), "mouse_left", "pad_right_trigger"},
    {"place", word("Place"), "mouse_right", "pad_left_trigger"},
    {"pick", word("Pick block"), "mouse_middle", "pad_right_thumb"},
    {"undo", word("Undo"), "ctrl+z", "pad_left"},
    {"redo", word("Redo"), "ctrl+y", "pad_right"},
    {"slot_1", word("Slot {}"), "1", "none"},
    {"slot_2", word("Slot {}"), "2", "none"},
    {"slot_3", word("Slot {}"), "3", "none"},
    {"slot_4", word("Slot {}"), "4", "none"},
    {"slot_5", word("Slot {}"), "5", "none"},
    {"slot_6", word("Slot {}"), "6", "none"},
    {"slot_7", word("Slot {}"), "7", "none"},
    {"slot_8", word("Slot {}"), "8", "none"},
    {"slot_9", word("Slot {}"), "9", "none"},
    {"next_slot", word("Next slot"), "wheel_down", "pad_right_bumper"},
    {"previous_slot", word("Previous slot"), "wheel_up", "pad_left_bumper"},
    {"palette", word("All blocks"), "e", "pad_x"},
    {"torch", word("Torch in the hand"), "l", "pad_up"},
    {"helm", word("Take the helm"), "h", "pad_down"},
    {"map", word("Map"), "m", "pad_back+pad_b"},
    {"mark", word("Mark this place"), "b", "none"},
    {"go_home", word("Go home"), "home", "none"},
    {"later", word("Later in the day"), "t", "pad_back+pad_right"},
    {"earlier", word("Earlier in the day"), "y", "pad_back+pad_left"},
    {"stop_day", word("Stop the day"), "p", "pad_back+pad_down"},
    {"pause", word("Pause"), "escape", "pad_start"},
    {"screenshot", word("Screenshot"), "f2", "pad_back+pad_x"},
    {"photo", word("Photo mode"), "f10", "pad_back+pad_a"},
    {"hide_hud", word("Hide all displays"), "f1", "pad_back+pad_up"},
    {"overlay", word("Numbers"), "f3", "pad_back+pad_start"},
    {"fullscreen", word("Fullscreen"), "f11", "none"},
    {"farther_view", word("See farther"), "right_bracket", "none"},
    {"nearer_view", word("See less far"), "left_bracket", "none"},
    {"better_quality", word("Better quality"), "plus", "none"},
    {"worse_quality", word("Lower quality"), "minus", "none"},
    {"calibrate", word("Calibrate the display"), "f9", "none"},
    {"freeze_culling", word("Freeze culling"), "f8", "none"},
};
static_assert(std::size(kTypes) == kActions);

/// Keys from kSpace on, as people read them. Marks are those of a US layout.
constexpr const char* kKeyLabels[] = {
    // clang-format off
    word("Space"), word("Shift"), word("Ctrl"), word("Alt"), word("Tab"), word("Enter"),
    word("Backspace"), word("Escape"), word("Caps Lock"),
    word("Insert"), word("Del"), word("Home key"), word("End"), word("Page up"),
    word("Page down"), word("Arrow up"), word("Arrow down"), word("Arrow left"),
    word("Arrow right"),
    "-", "+", "[", "]", "\\", ";", "'", ",", ".", "/", "`",
    word("Left click"), word("Right click"), word("Middle click"), word("Mouse {}"),
    word("Mouse {}"), word("Wheel up"), word("Wheel down"),
    "A", "B", "X", "Y", word("Left bumper"), word("Right bumper"), word("Back button"),
    word("Start button"), word("Guide button"), word("Left stick pressed"),
    word("Right stick pressed"), word("D-pad up"), word("D-pad right"), word("D-pad down"),
    word("D-pad left"),
    word("Left stick left"), word("Left stick right"), word("Left stick up"),
    word("Left stick down"), word("Right stick left"), word("Right stick right"),
    word("Right stick up"), word("Right stick down"), word("Left trigger"), word("Right trigger"),
    // clang-format on
};
constexpr auto kFirstLabelled = static_cast<std::size_t>(Key::kSpace);
static_assert(std::size(kKeyLabels) == static_cast<std::size_t>(Key::kCount) - kFirstLabelled);

/// Letters and digits as they are on their keys.
std::string key_label(Key key) {
  const auto number = static_cast<std::size_t>(key);
  if (number >= kFirstLabelled)
    return tr_format(kKeyLabels[number - kFirstLabelled], key == Key::kMouse5 ? 5 : 4);
  std::string label(platform::key_name(key));
  for (char& c : label) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return label;
}

constexpr std::string_view kControlPrefix = "ctrl+", kPadPrefix = "pad_back+";

bool is_bound(const Bindings& bindings, Chord chord) {
  return std::any_of(bindings.of_action.begin(), bindings.of_action.end(),
                     [&](const Binding& b) { return b.key == chord || b.pad == chord; });
}

}  // namespace

const ActionType& action_type(Action action) {
  return kTypes[static_cast<std::size_t>(action)];
}

std::string action_label(Action action) {
  return tr_format(action_type(action).label,
                   static_cast<int>(action) - static_cast<int>(Action::kSlot1) + 1);
}

std::optional<Action> action_named(std::string_view name) {
  const auto found = std::find_if(std::begin(kTypes), std::end(kTypes),
                                  [&](const ActionType& type) { return type.name == name; });
  if (found == std::end(kTypes)) return std::nullopt;
  return static_cast<Action>(found - std::begin(kTypes));
}

Key control_of(Key key) {
  return platform::is_pad(key) ? Key::kPadBack : Key::kControl;
}

std::string print_chord(Chord chord) {
  const std::string_view prefix = platform::is_pad(chord.key) ? kPadPrefix : kControlPrefix;
  return std::string(chord.control ? prefix : "") + std::string(platform::key_name(chord.key));
}

std::optional<Chord> parse_chord(std::string_view text) {
  Chord chord;
  const bool on_pad = text.starts_with(kPadPrefix);
  chord.control = on_pad || text.starts_with(kControlPrefix);
  if (chord.control) text.remove_prefix((on_pad ? kPadPrefix : kControlPrefix).size());
  const std::optional<Key> key = platform::key_named(text);
  const bool fits = key && !(chord.control && (*key == Key::kNone || *key == control_of(*key) ||
                                               platform::is_pad(*key) != on_pad));
  if (!fits) return std::nullopt;
  chord.key = *key;
  return chord;
}

std::string chord_label(Chord chord) {
  if (chord.key == Key::kNone) return "-";
  const std::string label = key_label(chord.key);
  return chord.control ? key_label(control_of(chord.key)) + "+" + label : label;
}

Bindings default_bindings() {
  Bindings bindings;
  for (std::size_t i = 0; i < kActions; ++i)
    bindings.of_action[i] = {*parse_chord(kTypes[i].key), *parse_chord(kTypes[i].pad)};
  return bindings;
}

std::vector<Action> conflicts_of(const Bindings& bindings, Action action) {
  std::vector<Action> out;
  const Binding& mine = bindings[action];
  const auto same = [](Chord a, Chord b) { return a == b && a.key != Key::kNone; };
  for (std::size_t i = 0; i < kActions; ++i) {
    const Binding& other = bindings.of_action[i];
    if (static_cast<Action>(i) != action &&
        (same(mine.key, other.key) || same(mine.pad, other.pad)))
      out.push_back(static_cast<Action>(i));
  }
  return out;
}

bool ActionFrame::any() const {
  return std::any_of(states_.begin(), states_.end(),
                     [](const State& state) { return state.down || state.presses != 0; });
}

ActionFrame::State ActionFrame::state_of(Chord chord, const InputFrame& input,
                                         const Bindings& bindings, double seconds) {
  State state;
  if (chord.key == Key::kNone) return state;
  // A key that went up does so for every chord it is in: nothing is left held.
  state.released = input.released(chord.key);
  const Key with = control_of(chord.key);
  // A key alone means nothing while it may be one of a chord.
  const bool has_chord = !chord.control && is_bound(bindings, {chord.key, true});
  const auto meant = [&](bool control) { return chord.control ? control : !control || !has_chord; };
  bool control = input.was_down(with);
  double notches = 0.0;
  for (const platform::InputEvent& event : input.events) {
    if (event.key == with) control = event.down;
    if (event.key == chord.key && event.down && meant(control)) notches += event.amount;
  }
  if (notches > 0.0) state.presses = std::max(1, static_cast<int>(std::lround(notches)));
  if (!input.down(chord.key))
    state.value = std::min(state.presses * kTapSeconds / std::max(seconds, kTapSeconds), 1.0);
  if (!meant(input.down(with))) return state;
  state.down = input.down(chord.key);
  state.value = std::max(state.value, std::min(double{input.value(chord.key)}, 1.0));
  return state;
}

ActionFrame::ActionFrame(const InputFrame& input, const Bindings& bindings, double seconds) {
  for (std::size_t i = 0; i < kActions; ++i) {
    const State key = state_of(bindings.of_action[i].key, input, bindings, seconds);
    const State pad = state_of(bindings.of_action[i].pad, input, bindings, seconds);
    State& state = states_[i];
    state.down = key.down || pad.down;
    state.presses = key.presses + pad.presses;
    state.released = (key.released || pad.released) && !state.down;
    state.value = std::max(key.value, pad.value);
  }
  State& pause = states_[index(Action::kPause)];
  for (const Key key : {Key::kEscape, Key::kPadStart})
    if (!is_bound(bindings, {key}))
      pause.presses += state_of({key}, input, bindings, seconds).presses;
}

}  // namespace skerry::game
