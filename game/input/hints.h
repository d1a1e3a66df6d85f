// Which keys a new player is shown, until they have been used.
#pragma once
#include <bitset>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "engine/core/result.h"
#include "game/input/actions.h"

namespace skerry::game {

/// The few keys that matter, one at a time. One that was used does not come again, nor one that was
/// shown long enough to a player who has been doing other things.
class Hints {
 public:
  static constexpr std::size_t kCount = 7;
  static constexpr double kLongEnough = 30.0;  ///< seconds in which the player did something

  /// What the player does in the world, in a frame of so many seconds.
  /// @param on_foot the keys that walk and jump do so; else their hints wait.
  void note(const ActionFrame& actions, double seconds, bool on_foot);
  /// "W, A, S, D: walk" of the first that was not used; none: all were.
  /// @param pad names a gamepad's buttons. @param on_foot as in note().
  std::optional<std::string> line(const Bindings& bindings, bool pad, bool on_foot) const;
  /// Whether one has gone since the last call.
  bool take_changed() { return std::exchange(changed_, false); }

  /// As a file keeps it: names of the hints that have gone. What is not understood is left out: the
  /// hints then come again.
  static Hints read(std::string_view json_text);
  std::string print() const;

 private:
  std::bitset<kCount> used_;
  std::size_t shown_ = 0;  // the first that was not used and may be shown
  double shown_s_ = 0.0;   // it was
  bool changed_ = false;
};

/// `hints.json` in the user's folder for configuration; empty if there is none.
std::filesystem::path hints_path();
/// A file that is not there, or cannot be read, has none used.
Hints load_hints(const std::filesystem::path& path);
/// Errors: the folder or file cannot be written.
Result<void> save_hints(const std::filesystem::path& path, const Hints& hints);

}  // namespace skerry::game
