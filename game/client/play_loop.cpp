#include "game/client/play_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "engine/core/log.h"
#include "game/client/screenshot.h"
#include "game/words/words.h"

namespace skerry::game {
namespace {

render::FixedPos fixed(const world::WorldPos& p) {
  return {p.x, p.y, p.z};
}
world::WorldPos place(const render::FixedPos& p) {
  return {p[0], p[1], p[2]};
}

/// Where the feet are when the eye is there.
Player player_at(const render::Camera& eye, double time_s) {
  return {world::moved(place(eye.position), {0.0, -kEyeHeight, 0.0}), eye.yaw_deg, eye.pitch_deg,
          time_s};
}

/// Ground at the spawn, wherever its island has drifted since. None: there is none.
std::optional<Spot> home_of(const world::World& world) {
  const world::Spawn spawn = world.spawn();
  (void)world.islands_near(spawn.feet, 0.0, 0.0);  // makes its island known
  const std::optional<world::IslandSpec> spec = world.island(spawn.island);
  if (!spec) return std::nullopt;
  // Of the spawn's island, even if it has left its course.
  const std::optional<world::Pose> now = world.pose(spawn.island, 0.0);
  const world::Pose pose = world.desc().generated || !now ? world::pose_at(*spec, 0.0) : *now;
  const glm::dvec3 feet =
      glm::conjugate(pose.rotation) * world::difference_blocks(spawn.feet, pose.origin);
  return Spot{spawn.island, lattice_pos(feet) + LatticePos{0, kContactGap, 0}, spawn.feet};
}

/// Where the seed makes no islands, the search for a spawn goes through all voxels of one: none
/// where a player comes back to ground that held them.
std::optional<Spot> spawn_of(const SessionClient& session, const world::World& world) {
  const std::optional<SavedPlay>& left = session.joined().play;
  const bool wanted = world.desc().generated || !left || !left->player.safe;
  return wanted ? home_of(world) : std::nullopt;
}

}  // namespace

PlayLoop::PlayLoop(const Machine& machine, const Bindings& bindings, const SceneOptions& options,
                   std::unique_ptr<SessionClient> session, std::unique_ptr<SceneView> view)
    : window_(machine.window),
      device_(machine.device),
      presenter_(machine.presenter),
      bindings_(&bindings),
      scene_(options),
      session_(std::move(session)),
      view_(std::move(view)),
      player_(player_at(view_->start_camera(), session_->time_s())),
      around_(view_->world()),
      wayfinder_(view_->world(), session_->joined().journal, spawn_of(*session_, view_->world())),
      day_(options.time_of_day_s) {
  const std::optional<SavedPlay>& left = session_->joined().play;
  if (left) hands_.hotbar() = left->hotbar;
  if (left && options.camera == left->eye) {
    player_ = Player(left->player, session_->time_s());
    day_stands_ = left->day_stands;
  } else if (options.camera) {
    // A place that was asked for is a view, most often in the air.
    player_.set_mode(MoveMode::kFly);
  }
  if (const std::optional<Spot> home = wayfinder_.home(); home && home->island)
    player_.set_home({*home->island, home->lattice});
  scene_.camera = player_.eye(around_);
}

Result<void> PlayLoop::save() {
  tell_session();
  return session_->save();
}

void PlayLoop::want_screenshot() {
  screenshot_wanted_ = true;
  view_->renderer().invalidate_shadows();  // so that the command draws the same shadows again
}

SceneView::Moment PlayLoop::moment() const {
  SceneView::Moment moment;
  moment.camera = {fixed(scene_.camera->position), scene_.camera->yaw_deg, scene_.camera->pitch_deg,
                   scene_.fov_deg};
  moment.time_of_day_s = day_.time_of_day_s();
  moment.world_time_s = player_.world_time_s();
  moment.freeze_culling = culling_frozen_;
  moment.may_lag = !screenshot_wanted_ && !photo_;
  moment.count_pixels = false;
  moment.exposure_ev = exposure_ev_;
  if (photo_) {
    moment.camera = {fixed(photo_->eye.position), photo_->eye.yaw_deg, photo_->eye.pitch_deg,
                     photo_->fov_deg};
    moment.time_of_day_s = photo_->time_of_day_s;
    if (photo_->exposure_ev) moment.exposure_ev = photo_->exposure_ev;
  }
  // A screenshot's command has no hands to mark a block with.
  if (const std::optional<Pick>& pick = hands_.pick(); pick && !screenshot_wanted_ && !photo_) {
    const VoxelBox box = pick_box(pick->block);
    const glm::dvec3 corner{pick->voxel.x, pick->voxel.y, pick->voxel.z};
    moment.marked = {pick->island, corner + box.min, corner + box.max, hands_.dig_progress()};
  }
  return moment;
}

Result<bool> PlayLoop::draw(const Layout& layout) {
  const SceneView::Moment now = moment();
  // A screenshot's command has no levels of detail that change.
  std::optional<double> blend_s;
  if (!screenshot_wanted_) blend_s = frame_s_;
  if (const auto done = view_->stream(now, blend_s); !done) return done.error();
  for (std::string& notice : view_->notices()) said_.push_back(std::move(notice));
  const platform::FramebufferSize window_px = window_.framebuffer_size();
  const std::optional<gpu::SwapchainFrame> frame =
      presenter_.acquire({window_px.width, window_px.height});
  if (!frame) return false;
  const VkExtent2D size = presenter_.extent();
  const ui::OverlayTriangles overlay = layout(size);
  Result<void> recorded;
  const auto bring_to_window = [&](VkCommandBuffer commands, gpu::Image& picture) {
    recorded =
        presenter_.record(commands, picture, *frame, overlay.vertices.empty() ? nullptr : &overlay);
  };
  view_->renderer().time_passes(overlay_shown_);
  const Result<std::uint64_t> value =
      view_->draw(now, size, bring_to_window, {&frame->wait, 1}, {&frame->signal, 1});
  if (!value) return value.error();
  presenter_.present(*frame, *value);
  if (!recorded) return recorded.error();
  scene_.size = {size.width, size.height};
  scene_.settings = view_->settings();
  scene_.settings.world_time_s = now.world_time_s;
  // A command meters what it draws and adapts to nothing, so F2 names the exposure.
  if (screenshot_wanted_ && !scene_.settings.exposure_ev)
    scene_.settings.exposure_ev = now.exposure_ev;
  if (std::exchange(screenshot_wanted_, false)) take_screenshot();
  return true;
}

void PlayLoop::take_screenshot() {
  SceneOptions taken = scene_;
  taken.time_of_day_s = day_.time_of_day_s();
  if (photo_) {
    taken.camera = photo_->eye;
    taken.fov_deg = photo_->fov_deg;
    taken.time_of_day_s = photo_->time_of_day_s;
  }
  std::optional<IslandView> from;
  const std::optional<std::uint64_t> island = player_.frame_island();
  if (const auto pose =
          island ? view_->world().pose(*island, taken.settings.world_time_s) : std::nullopt)
    from = seen_from(*island, *pose, *taken.camera);
  const auto path = save_screenshot(device_, view_->renderer().picture(), taken, from);
  if (!path) {
    log_error(path.error().message);
    said_.push_back(path.error().message);
    return;
  }
  said_.push_back(tr_format("Saved {}", path->string()));
  fmt::print("{}\n{}\n", path->string(), shot_command(taken));
  std::fflush(stdout);
}

}  // namespace skerry::game
