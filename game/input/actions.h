// What a player can do, and which keys do it.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "engine/platform/input.h"

namespace skerry::game {

/// The order is that of the screen on which they are bound.
enum class Action : std::uint8_t {
  kForward,
  kBack,
  kLeft,
  kRight,
  kJump,    ///< in water: swim up; flying: rise
  kCrouch,  ///< flying: sink
  kFast,
  kFly,
  kNoclip,
  kFasterFlight,
  kSlowerFlight,
  kLookUp,
  kLookDown,
  kLookLeft,
  kLookRight,
  kDig,
  kPlace,
  kPick,  ///< takes the block looked at into the hand
  kUndo,
  kRedo,
  kSlot1,
  kSlot2,
  kSlot3,
  kSlot4,
  kSlot5,
  kSlot6,
  kSlot7,
  kSlot8,
  kSlot9,
  kNextSlot,
  kPreviousSlot,
  kPalette,
  kTorch,
  kHelm,
  kMap,
  kMark,  ///< a waypoint where the player is
  kGoHome,
  kLater,
  kEarlier,
  kStopDay,
  kPause,
  kScreenshot,
  kPhoto,
  kHideHud,
  kOverlay,
  kFullscreen,
  kFartherView,
  kNearerView,
  kBetterQuality,
  kWorseQuality,
  kCalibrate,
  kFreezeCulling,
  kCount
};

inline constexpr std::size_t kActions = static_cast<std::size_t>(Action::kCount);

/// The properties of an action.
struct ActionType {
  std::string_view name;      ///< as files write it
  const char* label;          ///< as people read it, a word of tr(); "{}": number of the slot
  std::string_view key, pad;  ///< what it is bound to by default, as parse_chord reads it
};
const ActionType& action_type(Action action);
/// As people read it.
std::string action_label(Action action);
std::optional<Action> action_named(std::string_view name);

/// A key, maybe together with Ctrl, or on a gamepad with Back. Written "ctrl+z", "pad_back+pad_y",
/// or "none".
struct Chord {
  platform::Key key = platform::Key::kNone;
  bool control = false;  ///< together with control_of(key)
  bool operator==(const Chord&) const = default;
};
/// What a key makes chords with: Ctrl, or Back on a gamepad.
platform::Key control_of(platform::Key key);
std::string print_chord(Chord chord);
std::optional<Chord> parse_chord(std::string_view text);
/// As people read it, in their language: "Ctrl+Z", "Left stick up"; "-" for none.
std::string chord_label(Chord chord);

/// How one action is reached.
struct Binding {
  Chord key;  ///< of keyboard or mouse
  Chord pad;  ///< of a gamepad
  bool operator==(const Binding&) const = default;
};

/// Which keys do what, and how fast the head turns.
struct Bindings {
  std::array<Binding, kActions> of_action;
  double mouse_speed = 1.0;  ///< times the usual, kMinTurnSpeed .. kMaxTurnSpeed
  double pad_speed = 1.0;    ///< likewise
  bool inverted = false;     ///< up looks down
  bool operator==(const Bindings&) const = default;

  const Binding& operator[](Action action) const {
    return of_action[static_cast<std::size_t>(action)];
  }
  Binding& operator[](Action action) { return of_action[static_cast<std::size_t>(action)]; }
};
inline constexpr double kMinTurnSpeed = 0.1, kMaxTurnSpeed = 5.0;

Bindings default_bindings();

/// Other actions that the same chord does.
std::vector<Action> conflicts_of(const Bindings& bindings, Action action);

/// What a frame's keys mean. Escape and a gamepad's Start pause wherever they are bound to nothing
/// else, so that no bindings lock anybody in.
class ActionFrame {
 public:
  ActionFrame() = default;  ///< no action is pressed
  /// @param seconds that the frame lasts: how much of it a tap is worth (kTapSeconds).
  ActionFrame(const platform::InputFrame& input, const Bindings& bindings, double seconds = 0.0);

  /// What went down and up between two frames counts as held for so long, or for the whole frame if
  /// that is shorter: else slow frames would lose every tap.
  static constexpr double kTapSeconds = 0.1;

  bool down(Action action) const { return states_[index(action)].down; }
  /// Went down during the frame, even if it is up again.
  bool pressed(Action action) const { return states_[index(action)].presses != 0; }
  /// Whether one is held or was pressed.
  bool any() const;
  /// How often: a wheel may turn by several notches.
  int presses(Action action) const { return states_[index(action)].presses; }
  bool released(Action action) const { return states_[index(action)].released; }
  /// How far, 0 .. 1; of what was tapped, the share of the frame for which it counts as held.
  double value(Action action) const { return states_[index(action)].value; }

 private:
  struct State {
    bool down = false, released = false;
    int presses = 0;
    double value = 0.0;
  };
  static std::size_t index(Action action) { return static_cast<std::size_t>(action); }
  static State state_of(Chord chord, const platform::InputFrame& input, const Bindings& bindings,
                        double seconds);
  std::array<State, kActions> states_{};
};

/// Bindings as a file held them, and what was wrong with it, each a line for the player; such parts
/// are as by default.
struct ReadBindings {
  Bindings bindings = default_bindings();
  std::vector<std::string> problems;
};
ReadBindings read_bindings(std::string_view json_text);
std::string print_bindings(const Bindings& bindings);

/// `controls.json` in the user's folder for configuration; empty if there is none.
std::filesystem::path bindings_path();
/// The user's bindings; a file that is not there is no problem.
ReadBindings load_bindings(const std::filesystem::path& path);
/// Errors: the folder or file cannot be written. What was there before and load_bindings had
/// problems with is kept beside it, with ".old" appended.
Result<void> save_bindings(const std::filesystem::path& path, const Bindings& bindings);

}  // namespace skerry::game
