#pragma once
#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace skerry::platform {

/// Everything that can be held or pressed: keys of a keyboard as a US layout names them, mouse
/// buttons, the wheel's two ways, buttons of a gamepad, and each way of its sticks.
enum class Key : std::uint8_t {
  kNone,
  // clang-format off
  kA, kB, kC, kD, kE, kF, kG, kH, kI, kJ, kK, kL, kM,
  kN, kO, kP, kQ, kR, kS, kT, kU, kV, kW, kX, kY, kZ,
  k0, k1, k2, k3, k4, k5, k6, k7, k8, k9,
  kF1, kF2, kF3, kF4, kF5, kF6, kF7, kF8, kF9, kF10, kF11, kF12,
  kSpace, kShift, kControl, kAlt, kTab, kEnter, kBackspace, kEscape, kCapsLock,
  kInsert, kDelete, kHome, kEnd, kPageUp, kPageDown, kUp, kDown, kLeft, kRight,
  kMinus, kPlus, kLeftBracket, kRightBracket, kBackslash, kSemicolon, kApostrophe, kComma,
  kPeriod, kSlash, kGrave,
  kMouseLeft, kMouseRight, kMouseMiddle, kMouse4, kMouse5, kWheelUp, kWheelDown,
  // In the order of GLFW_GAMEPAD_BUTTON_*.
  kPadA, kPadB, kPadX, kPadY, kPadLeftBumper, kPadRightBumper, kPadBack, kPadStart, kPadGuide,
  kPadLeftThumb, kPadRightThumb, kPadUp, kPadRight, kPadDown, kPadLeft,
  // How far these are pressed counts, see InputFrame::value.
  kPadLeftStickLeft, kPadLeftStickRight, kPadLeftStickUp, kPadLeftStickDown,
  kPadRightStickLeft, kPadRightStickRight, kPadRightStickUp, kPadRightStickDown,
  kPadLeftTrigger, kPadRightTrigger,
  // clang-format on
  kCount
};

/// Lower-case words joined by '_', unique, as files write them; "none" for kNone.
std::string_view key_name(Key key);
std::optional<Key> key_named(std::string_view name);
/// Whether it is a gamepad's.
constexpr bool is_pad(Key key) {
  return key >= Key::kPadA && key < Key::kCount;
}

/// A gamepad as its driver reports it, mapped to the usual layout.
struct PadState {
  std::bitset<15> buttons;      ///< from kPadA on
  std::array<float, 6> axes{};  ///< left x, y, right x, y: -1 left or up .. 1; triggers: -1 .. 1
};

/// One thing that happened, in a frame's order.
struct InputEvent {
  Key key = Key::kNone;    ///< that went down or up; kNone: a character was typed
  bool down = false;       ///< or up; the wheel's ways only go down
  float amount = 1.0f;     ///< notches of the wheel; 1 for all else
  char32_t character = 0;  ///< typed
  glm::dvec2 pointer{};    ///< where the pointer was then, as InputFrame::pointer
};

/// What happened since the frame before.
class InputFrame {
 public:
  bool down(Key key) const { return down_[index(key)]; }  ///< held at the end of the frame
  bool pressed(Key key) const {
    return pressed_[index(key)];
  }  ///< went down during it, even if it is up again
  bool released(Key key) const { return released_[index(key)]; }  ///< went up during it
  int presses(Key key) const;  ///< how often it went down during it
  bool was_down(Key key) const { return was_down_[index(key)]; }  ///< held when it began
  /// How far: 0 .. 1 for sticks (beyond their dead zone) and triggers, notches of the wheel, 0 or 1
  /// for all else.
  float value(Key key) const;

  glm::dvec2 mouse_delta{};  ///< pixels, right and down
  glm::dvec2 pointer{};      ///< from the picture's upper left corner [pixels]
  double scroll = 0.0;       ///< notches, up is positive
  bool pad = false;          ///< a gamepad is plugged in
  /// In order, at most kMaxEvents; more change what is held at the end of the frame, but were not
  /// seen to happen.
  std::vector<InputEvent> events;

  static constexpr std::size_t kMaxEvents = 1024;

 private:
  friend class Input;
  friend class HeldBack;
  using Keys = std::bitset<static_cast<std::size_t>(Key::kCount)>;
  static constexpr std::size_t kFirstAxis = static_cast<std::size_t>(Key::kPadLeftStickLeft);
  static constexpr std::size_t kAxes = static_cast<std::size_t>(Key::kCount) - kFirstAxis;
  static std::size_t index(Key key) { return static_cast<std::size_t>(key); }
  Keys was_down_, down_, pressed_, released_;
  std::array<float, kAxes> axes_{};
};

/// Gathers events between frames.
class Input {
 public:
  void set_key(Key key, bool down);
  /// The pointer is at (x, y). The first place after reset_pointer() is no motion.
  /// @return how far it moved.
  glm::dvec2 move_pointer(glm::dvec2 place);
  /// So much of what moved was no motion after all.
  void take_back_motion(glm::dvec2 delta) { frame_.mouse_delta -= delta; }
  /// It was put there by somebody else than the player's hand: no motion.
  void place_pointer(glm::dvec2 place);
  void reset_pointer() { pointer_known_ = false; }
  void add_scroll(double notches);
  void type(char32_t character);
  /// How the gamepad is now; none: nothing is plugged in, and whatever was held goes up.
  void set_pad(const std::optional<PadState>& pad);
  /// What the mouse has done since the last take() is not seen to happen. What it holds stays down.
  void drop_mouse();
  /// Everything held goes up: the window that has the focus now receives the releases.
  void lose_focus();
  /// @return what was gathered; gathering starts anew, held keys stay down.
  InputFrame take();

 private:
  void set_axis(std::size_t axis, float value);
  void note(InputEvent event);
  InputFrame frame_;
  glm::dvec2 pointer_{};
  bool pointer_known_ = false;
};

/// Keeps keys that were meant for one thing from meaning another: those that are held when a screen
/// opens or closes mean nothing until they have gone up.
class HeldBack {
 public:
  /// From now on, everything that this frame holds or types is kept back.
  void hold(const InputFrame& frame);
  /// The frame without what is kept back. Once a frame.
  InputFrame filtered(InputFrame frame);

 private:
  InputFrame::Keys keys_;
  bool text_ = false;
};

}  // namespace skerry::platform
