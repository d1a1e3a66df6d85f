// Changes of blocks, and taking them back.
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

#include "game/player/player.h"
#include "world/voxel/blocks.h"
#include "world/voxel/coords.h"

namespace skerry::game {

/// One voxel that something changed.
struct BlockChange {
  std::uint64_t island = 0;
  world::IVec3 voxel;
  world::BlockId before = world::kAir, after = world::kAir;
  bool operator==(const BlockChange&) const = default;
};

/// Where edits go.
class BlockEditor {
 public:
  virtual ~BlockEditor() = default;
  /// @return false: refused, nothing has changed.
  virtual bool set_block(std::uint64_t island, world::IVec3 voxel, world::BlockId block) = 0;
};

/// Whether a solid may be placed in a voxel: no player stands there.
using VoxelFree = std::function<bool(std::uint64_t island, world::IVec3 voxel)>;

/// What one press of a button changed: the block itself and what came down with it.
using EditAct = std::vector<BlockChange>;

/// What came of taking an act back, or of doing it again.
enum class Replay : std::uint8_t {
  kNothing,  ///< there is no act left
  kDone,     ///< at least in part
  kRefused,  ///< it waits: out of reach, not loaded, or somebody stands there
};

/// The last acts of a player, to take back and to do again.
class EditHistory {
 public:
  static constexpr std::size_t kMaxActs = 256;  ///< older ones are dropped

  /// Does an act and records it; what had been undone cannot be redone any more.
  /// @return whether its first change was accepted; else nothing has changed.
  bool perform(const EditAct& act, BlockEditor& blocks);
  /// Puts back what the last act changed, or does again what was taken back last. A voxel that is
  /// no longer as this history left it stays as it is, and so does one that `free` denies. An act
  /// of which nothing could be done stays the next in line; one of which nothing is left, because
  /// something else has changed all its voxels, is dropped for the one before it.
  Replay undo(const Surroundings& around, BlockEditor& blocks, const VoxelFree& free);
  Replay redo(const Surroundings& around, BlockEditor& blocks, const VoxelFree& free);
  /// Acts that undo() can put back. For tests: a refused act and a dropped one look alike from
  /// outside.
  std::size_t undoable() const { return done_.size(); }

 private:
  std::deque<EditAct> done_, undone_;
};

}  // namespace skerry::game
