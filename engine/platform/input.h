#pragma once
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>

namespace skerry::platform {

/// Keys and mouse buttons the program knows.
enum class Key : std::uint8_t {
  kW,
  kA,
  kS,
  kD,
  kF,
  kL,
  kP,
  kT,
  kY,
  kSpace,
  kShift,
  kControl,
  kEscape,
  kMinus,
  kPlus,
  kLeftBracket,
  kRightBracket,
  kF2,
  kF3,
  kF8,
  kF9,
  kF11,
  kUp,
  kDown,
  kLeft,
  kRight,
  kMouseLeft,
  kCount
};

/// What happened since the frame before.
class InputFrame {
 public:
  bool down(Key key) const { return down_[index(key)]; }  ///< held at the end of the frame
  bool pressed(Key key) const {
    return pressed_[index(key)];
  }  ///< went down during it, even if it is up again
  bool released(Key key) const { return released_[index(key)]; }  ///< went up during it
  glm::dvec2 mouse_delta{};                                       ///< pixels, right and down
  double scroll = 0.0;                                            ///< notches, up is positive

 private:
  friend class Input;
  using Keys = std::bitset<static_cast<std::size_t>(Key::kCount)>;
  static std::size_t index(Key key) { return static_cast<std::size_t>(key); }
  Keys down_, pressed_, released_;
};

/// Gathers events between frames.
class Input {
 public:
  void set_key(Key key, bool down);
  /// The pointer is at (x, y). The first place after forget_pointer() is no motion.
  void move_pointer(glm::dvec2 place);
  void forget_pointer() { pointer_known_ = false; }
  void add_scroll(double notches) { frame_.scroll += notches; }
  /// Everything held goes up: whoever has the focus now sees the releases, we would not.
  void lose_focus();
  /// @return what was gathered; gathering starts anew, held keys stay down.
  InputFrame take();

 private:
  InputFrame frame_;
  glm::dvec2 pointer_{};
  bool pointer_known_ = false;
};

}  // namespace skerry::platform
