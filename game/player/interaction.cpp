#include "game/player/interaction.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "game/player/edit_rules.h"
#include "world/islands/dig.h"

namespace skerry::game {

void Hotbar::scroll(int slots) {
  selected = static_cast<int>(world::floor_mod(std::int64_t{selected} + slots, kHotbarSlots));
}

void Hotbar::take(world::BlockId block) {
  const auto found = std::find(blocks.begin(), blocks.end(), block);
  if (found != blocks.end())
    selected = static_cast<int>(found - blocks.begin());
  else
    blocks[static_cast<std::size_t>(selected)] = block;
}

void Interaction::advance(double seconds, const HandIntent& intent, const Player& player,
                          const CameraPlace& eye, const Surroundings& around, BlockEditor& blocks) {
  if (intent.slot) hotbar_.selected = *intent.slot;
  hotbar_.scroll(intent.scroll);
  const VoxelFree free = [&](std::uint64_t island, world::IVec3 voxel) {
    return leaves_free(player, around, island, voxel);
  };
  replay_refused_ = false;
  if (intent.undo) replay_refused_ |= history_.undo(around, blocks, free) == Replay::kRefused;
  if (intent.redo) replay_refused_ |= history_.redo(around, blocks, free) == Replay::kRefused;

  const auto point = [&] {
    return pick_block(around, eye.position, view_direction(eye.yaw_deg, eye.pitch_deg), kHandReach,
                      player.world_time_s());
  };
  const std::optional<Pick> before = std::exchange(pick_, point());
  // Looking at another block, or releasing, restarts.
  const bool same = pick_ && before && pick_->island == before->island &&
                    pick_->voxel == before->voxel && pick_->block == before->block;
  if (!same || !intent.dig) dig_progress_ = 0.0;
  dug_ &= intent.dig && !intent.repeats;
  if (pick_ && intent.take_block) hotbar_.take(pick_->block);
  if (pick_ && intent.dig && !dug_) dug_ = dig(seconds, around, blocks);
  until_place_s_ = intent.place ? until_place_s_ - seconds : 0.0;
  stood_in_way_ &= intent.place;
  stands_in_way_ = false;
  if (pick_ && intent.place && until_place_s_ <= 0.0) {
    until_place_s_ = intent.repeats ? kPlacePeriod : std::numeric_limits<double>::infinity();
    place(player, around, blocks);
  }
  if (!pick_) pick_ = point();  // an edit has changed what is there
}

bool Interaction::dig(double seconds, const Surroundings& around, BlockEditor& blocks) {
  if (!world::can_dig(pick_->block)) return false;
  const double needed = world::dig_seconds(pick_->block);
  dig_progress_ = needed > 0.0 ? std::min(1.0, dig_progress_ + seconds / needed) : 1.0;
  if (dig_progress_ < 1.0) return false;
  history_.perform(dig_act(around, pick_->island, pick_->voxel), blocks);
  dig_progress_ = 0.0;
  pick_.reset();
  return true;
}

void Interaction::place(const Player& player, const Surroundings& around, BlockEditor& blocks) {
  const EditAct act = place_act(around, *pick_, hotbar_.held(), player.world_time_s());
  if (act.empty()) return;
  const BlockChange& change = act.front();
  if (world::is_solid(change.after) && !leaves_free(player, around, change.island, change.voxel)) {
    stands_in_way_ = !std::exchange(stood_in_way_, true);
    return;
  }
  if (history_.perform(act, blocks)) pick_.reset();
}

}  // namespace skerry::game
