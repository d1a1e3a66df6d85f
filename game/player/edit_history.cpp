#include "game/player/edit_history.h"

#include <optional>
#include <utility>

namespace skerry::game {
namespace {

/// Makes changes that still fit what is there. @return kNothing: none does, nor ever will.
Replay apply(const EditAct& act, const Surroundings& around, BlockEditor& blocks,
             const VoxelFree& free) {
  Replay came = Replay::kNothing;
  for (const BlockChange& change : act) {
    const std::optional<world::BlockId> there = around.block(change.island, change.voxel);
    if (there && *there != change.before) continue;
    const bool denied =
        !there || (world::is_solid(change.after) && !free(change.island, change.voxel));
    if (!denied && blocks.set_block(change.island, change.voxel, change.after))
      came = Replay::kDone;
    else if (came == Replay::kNothing)
      came = Replay::kRefused;
  }
  return came;
}

/// What puts an act's blocks back: last changed, first restored.
EditAct reversed(const EditAct& act) {
  EditAct back(act.rbegin(), act.rend());
  for (BlockChange& change : back) std::swap(change.before, change.after);
  return back;
}

}  // namespace

bool EditHistory::perform(const EditAct& act, BlockEditor& blocks) {
  if (act.empty()) return false;
  EditAct done;
  for (const BlockChange& change : act) {
    if (blocks.set_block(change.island, change.voxel, change.after)) done.push_back(change);
    if (done.empty()) return false;
  }
  undone_.clear();
  done_.push_back(std::move(done));
  if (done_.size() > kMaxActs) done_.pop_front();
  return true;
}

Replay EditHistory::undo(const Surroundings& around, BlockEditor& blocks, const VoxelFree& free) {
  for (; !done_.empty(); done_.pop_back()) {
    const Replay came = apply(reversed(done_.back()), around, blocks, free);
    if (came == Replay::kNothing) continue;
    if (came == Replay::kRefused) return came;
    undone_.push_back(std::move(done_.back()));
    done_.pop_back();
    return came;
  }
  return Replay::kNothing;
}

Replay EditHistory::redo(const Surroundings& around, BlockEditor& blocks, const VoxelFree& free) {
  for (; !undone_.empty(); undone_.pop_back()) {
    const Replay came = apply(undone_.back(), around, blocks, free);
    if (came == Replay::kNothing) continue;
    if (came == Replay::kRefused) return came;
    done_.push_back(std::move(undone_.back()));
    undone_.pop_back();
    return came;
  }
  return Replay::kNothing;
}

}  // namespace skerry::game
