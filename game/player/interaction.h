// What a player's hands do: point at a block, dig it, place another, choose which, take it back.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "game/player/edit_history.h"
#include "game/player/hotbar.h"
#include "game/player/pick.h"
#include "game/player/player.h"
#include "world/voxel/blocks.h"

namespace skerry::game {

/// How far hands reach from the eye [blocks].
inline constexpr double kHandReach = 6.0;
/// Someone who holds the button places a block so often [s].
inline constexpr double kPlacePeriod = 0.2;

/// What the person wants their hands to do in a frame.
struct HandIntent {
  bool dig = false;         ///< held down
  bool place = false;       ///< held down
  bool repeats = true;      ///< what is held goes on with the next block
  bool take_block = false;  ///< the block pointed at comes into the hand
  bool undo = false, redo = false;
  std::optional<int> slot = {};  ///< selects 0 .. kHotbarSlots - 1
  int scroll = 0;                ///< slots to go on; negative: back
};

/// A player's hands. Drawing code reads pick(), dig_progress() and hotbar(); all are plain values.
class Interaction {
 public:
  /// One frame: points, then does what is asked. @param eye of the player, at
  /// player.world_time_s().
  /// @param blocks where edits go; may refuse them.
  void advance(double seconds, const HandIntent& intent, const Player& player,
               const CameraPlace& eye, const Surroundings& around, BlockEditor& blocks);

  /// What is pointed at, within reach.
  const std::optional<Pick>& pick() const { return pick_; }
  /// How much of pick() is dug: 0 .. 1. 0: not begun.
  double dig_progress() const { return dig_progress_; }
  Hotbar& hotbar() { return hotbar_; }
  const Hotbar& hotbar() const { return hotbar_; }
  const EditHistory& history() const { return history_; }
  /// Whether the last frame's undo or redo found an act that cannot be done from here, or now.
  bool replay_refused() const { return replay_refused_; }
  /// Whether the player stands where the last frame would have placed a block, for the first time
  /// since the button went down.
  bool stands_in_way() const { return stands_in_way_; }

 private:
  /// @return whether the block is dug.
  bool dig(double seconds, const Surroundings& around, BlockEditor& blocks);
  void place(const Player& player, const Surroundings& around, BlockEditor& blocks);

  std::optional<Pick> pick_;
  double dig_progress_ = 0.0;
  double until_place_s_ = 0.0;  // while the button is held
  bool dug_ = false;            // a block, since the button went down
  Hotbar hotbar_;
  EditHistory history_;
  bool replay_refused_ = false;
  bool stands_in_way_ = false, stood_in_way_ = false;  // in this frame; since the button went down
};

}  // namespace skerry::game
