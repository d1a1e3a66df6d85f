#include "engine/platform/input.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace skerry::platform {
namespace {

constexpr std::string_view kNames[] = {
    // clang-format off
    "none",
    "a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m",
    "n", "o", "p", "q", "r", "s", "t", "u", "v", "w", "x", "y", "z",
    "0", "1", "2", "3", "4", "5", "6", "7", "8", "9",
    "f1", "f2", "f3", "f4", "f5", "f6", "f7", "f8", "f9", "f10", "f11", "f12",
    "space", "shift", "ctrl", "alt", "tab", "enter", "backspace", "escape", "caps_lock",
    "insert", "delete", "home", "end", "page_up", "page_down", "up", "down", "left", "right",
    "minus", "plus", "left_bracket", "right_bracket", "backslash", "semicolon", "apostrophe",
    "comma", "period", "slash", "grave",
    "mouse_left", "mouse_right", "mouse_middle", "mouse_4", "mouse_5", "wheel_up", "wheel_down",
    "pad_a", "pad_b", "pad_x", "pad_y", "pad_left_bumper", "pad_right_bumper", "pad_back",
    "pad_start", "pad_guide", "pad_left_thumb", "pad_right_thumb", "pad_up", "pad_right",
    "pad_down", "pad_left",
    "pad_left_stick_left", "pad_left_stick_right", "pad_left_stick_up", "pad_left_stick_down",
    "pad_right_stick_left", "pad_right_stick_right", "pad_right_stick_up", "pad_right_stick_down",
    "pad_left_trigger", "pad_right_trigger",
    // clang-format on
};
static_assert(std::size(kNames) == static_cast<std::size_t>(Key::kCount));

// A worn stick rests this far from its middle.
constexpr float kDeadZone = 0.18f;
// Apart, so that a stick held at the edge does not chatter.
constexpr float kAxisDown = 0.5f, kAxisUp = 0.4f;

/// 0 within the dead zone, then evenly up to 1. A driver's NaN is rest.
float beyond_dead_zone(float value) {
  if (!(value > kDeadZone)) return 0.0f;
  return std::min((value - kDeadZone) / (1.0f - kDeadZone), 1.0f);
}

}  // namespace

std::string_view key_name(Key key) {
  return kNames[static_cast<std::size_t>(key)];
}

std::optional<Key> key_named(std::string_view name) {
  const auto found = std::find(std::begin(kNames), std::end(kNames), name);
  if (found == std::end(kNames)) return std::nullopt;
  return static_cast<Key>(found - std::begin(kNames));
}

float InputFrame::value(Key key) const {
  if (key == Key::kWheelUp) return static_cast<float>(std::max(scroll, 0.0));
  if (key == Key::kWheelDown) return static_cast<float>(std::max(-scroll, 0.0));
  if (index(key) >= kFirstAxis) return axes_[index(key) - kFirstAxis];
  return down(key) ? 1.0f : 0.0f;
}

int InputFrame::presses(Key key) const {
  return static_cast<int>(
      std::count_if(events.begin(), events.end(),
                    [key](const InputEvent& event) { return event.key == key && event.down; }));
}

void Input::note(InputEvent event) {
  event.pointer = frame_.pointer;
  if (frame_.events.size() < InputFrame::kMaxEvents) frame_.events.push_back(event);
}

void Input::set_key(Key key, bool down) {
  const std::size_t i = InputFrame::index(key);
  if (down == frame_.down_[i]) return;  // key repeat
  frame_.down_[i] = down;
  (down ? frame_.pressed_ : frame_.released_)[i] = true;
  note({key, down});
}

glm::dvec2 Input::move_pointer(glm::dvec2 place) {
  const glm::dvec2 delta = pointer_known_ ? place - pointer_ : glm::dvec2(0.0);
  frame_.mouse_delta += delta;
  place_pointer(place);
  return delta;
}

void Input::place_pointer(glm::dvec2 place) {
  pointer_ = place;
  frame_.pointer = place;
  pointer_known_ = true;
}

void Input::add_scroll(double notches) {
  if (notches == 0.0) return;
  frame_.scroll += notches;
  const Key way = notches > 0.0 ? Key::kWheelUp : Key::kWheelDown;
  frame_.pressed_[InputFrame::index(way)] = frame_.released_[InputFrame::index(way)] = true;
  note({way, true, static_cast<float>(std::abs(notches))});
}

void Input::type(char32_t character) {
  note({Key::kNone, false, 1.0f, character});
}

void Input::set_axis(std::size_t axis, float value) {
  const auto key = static_cast<Key>(InputFrame::kFirstAxis + axis);
  frame_.axes_[axis] = value;
  set_key(key, value > (frame_.down(key) ? kAxisUp : kAxisDown));
}

void Input::set_pad(const std::optional<PadState>& pad) {
  const PadState state = pad.value_or(PadState{{}, {0.0f, 0.0f, 0.0f, 0.0f, -1.0f, -1.0f}});
  if (!pad && !frame_.pad) return;
  frame_.pad = pad.has_value();
  for (std::size_t i = 0; i < state.buttons.size(); ++i)
    set_key(static_cast<Key>(InputFrame::index(Key::kPadA) + i), state.buttons[i]);
  for (std::size_t i = 0; i < 4; ++i) {
    set_axis(2 * i, beyond_dead_zone(-state.axes[i]));
    set_axis(2 * i + 1, beyond_dead_zone(state.axes[i]));
  }
  set_axis(8, beyond_dead_zone(0.5f + 0.5f * state.axes[4]));
  set_axis(9, beyond_dead_zone(0.5f + 0.5f * state.axes[5]));
}

void Input::drop_mouse() {
  const auto of_mouse = [](Key key) { return key >= Key::kMouseLeft && key <= Key::kWheelDown; };
  std::erase_if(frame_.events, [&](const InputEvent& event) { return of_mouse(event.key); });
  for (std::size_t i = 0; i < frame_.down_.size(); ++i) {
    if (!of_mouse(static_cast<Key>(i))) continue;
    frame_.was_down_[i] = frame_.down_[i];
    frame_.pressed_[i] = frame_.released_[i] = false;
  }
  frame_.scroll = 0.0;
  frame_.mouse_delta = {};
}

void Input::lose_focus() {
  for (std::size_t i = 0; i < frame_.down_.size(); ++i)
    if (frame_.down_[i]) set_key(static_cast<Key>(i), false);
  frame_.axes_.fill(0.0f);
  std::erase_if(frame_.events, [](const InputEvent& event) { return event.key == Key::kNone; });
  reset_pointer();
}

void HeldBack::hold(const InputFrame& frame) {
  keys_ |= frame.down_ | frame.pressed_;
  text_ = true;
}

InputFrame HeldBack::filtered(InputFrame frame) {
  const InputFrame::Keys hidden = keys_;
  keys_ &= frame.down_;
  frame.was_down_ &= ~hidden;
  frame.down_ &= ~hidden;
  frame.pressed_ &= ~hidden;
  frame.released_ &= ~hidden;
  for (std::size_t i = 0; i < frame.axes_.size(); ++i)
    if (hidden[InputFrame::kFirstAxis + i]) frame.axes_[i] = 0.0f;
  // A key that is held goes on typing.
  const bool types = !text_ && hidden.none();
  std::erase_if(frame.events, [&](const InputEvent& event) {
    return event.key == Key::kNone ? !types : hidden[InputFrame::index(event.key)];
  });
  if (text_) {
    frame.scroll = 0.0;
    frame.mouse_delta = {};
  }
  text_ = false;
  return frame;
}

InputFrame Input::take() {
  InputFrame taken = std::exchange(frame_, {});
  frame_.was_down_ = frame_.down_ = taken.down_;
  frame_.axes_ = taken.axes_;
  frame_.pointer = taken.pointer;
  frame_.pad = taken.pad;
  return taken;
}

}  // namespace skerry::platform
