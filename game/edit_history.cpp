#include "game/edit_history.h"

#include <utility>

namespace skerry::game {
namespace {

/// Makes changes that still fit what is there.
void apply(const EditAct& act, const Surroundings& around, BlockEditor& blocks,
           const VoxelFree& free) {
  for (const BlockChange& change : act) {
    if (around.block(change.island, change.voxel) != change.before) continue;
    if (world::is_solid(change.after) && !free(change.island, change.voxel)) continue;
    blocks.set_block(change.island, change.voxel, change.after);
  }
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

bool EditHistory::undo(const Surroundings& around, BlockEditor& blocks, const VoxelFree& free) {
  if (done_.empty()) return false;
  apply(reversed(done_.back()), around, blocks, free);
  undone_.push_back(std::move(done_.back()));
  done_.pop_back();
  return true;
}

bool EditHistory::redo(const Surroundings& around, BlockEditor& blocks, const VoxelFree& free) {
  if (undone_.empty()) return false;
  apply(undone_.back(), around, blocks, free);
  done_.push_back(std::move(undone_.back()));
  undone_.pop_back();
  return true;
}

}  // namespace skerry::game
