// What is heard of a run of the game.
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "game/client/play_loop.h"

namespace skerry::game {
namespace {

/// A block's middle in the world, or where the eye is if its island is gone.
world::WorldPos middle_of(const world::World& world, std::uint64_t island, world::IVec3 voxel,
                          double time_s, world::WorldPos otherwise) {
  const std::optional<world::Pose> pose = world.pose(island, time_s);
  if (!pose) return otherwise;
  const glm::dvec3 middle{voxel.x + 0.5, voxel.y + 0.5, voxel.z + 0.5};
  return world::moved(pose->origin, pose->rotation * middle);
}

}  // namespace

PlayMoment PlayLoop::sound_moment(double seconds) const {
  PlayMoment now;
  now.seconds = seconds;
  now.velocity = player_.velocity();
  now.walks = player_.mode() == MoveMode::kWalk;
  now.on_ground = player_.on_ground();
  now.in_water = player_.in_water();
  now.crouching = player_.crouching();
  const PlayerState state = player_.state();
  if (state.island && now.on_ground) {
    const glm::ivec3 below(glm::floor(lattice_blocks(state.lattice) - glm::dvec3{0.0, 0.1, 0.0}));
    now.ground = around_.block(*state.island, {below.x, below.y, below.z}).value_or(world::kAir);
  }
  now.dig_progress = hands_.dig_progress();
  now.bump = helm_.bump();
  if (const std::optional<Pick>& pick = hands_.pick()) {
    now.dug = pick->block;
    now.pointed_at = middle_of(view_->world(), pick->island, beyond_face(pick->voxel, pick->face),
                               player_.world_time_s(), scene_.camera->position);
  }
  return now;
}

SoundFrame PlayLoop::sound_frame(double seconds) {
  SoundFrame frame;
  frame.world = session_->world();
  frame.seconds = seconds;
  frame.paused = rests_;
  const CameraPlace& eye = *scene_.camera;
  frame.listener = {eye.position, player_.frame_island(), player_.world_time_s()};
  frame.yaw_deg = eye.yaw_deg;
  frame.air_speed = glm::length(player_.velocity());
  frame.strains = helm_.held_fast();
  std::vector<EditHeard> heard;
  for (const EditAnswer& done : session_->take_edits()) {
    const Edit& edit = done.edit;
    frame.changes.push_back({edit.island, edit.voxel, edit.block});
    heard.push_back(
        {done.was, edit.block,
         middle_of(view_->world(), edit.island, edit.voxel, player_.world_time_s(), eye.position)});
  }
  if (!rests_) frame.events = sounds_.advance(sound_moment(seconds), heard);
  return frame;
}

}  // namespace skerry::game
