#include "game/client/backdrop.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

namespace skerry::game {
namespace {

constexpr double kTurnDegPerSecond = 1.0;
constexpr double kStartDeg = -60.0;  // with the morning's sun behind the camera
constexpr double kLookDownDeg = 16.0;
constexpr int kMorningS = 9 * 3600 + 1800;
constexpr double kNearest = 70.0, kFarthest = 190.0;  // blocks from the island's middle
constexpr double kWindowSide = 14.0;                  // degrees: beside the panel, not behind it

}  // namespace

Result<std::unique_ptr<Backdrop>> Backdrop::create(gpu::Device& device, const SceneOptions& options,
                                                   View view) {
  Result<std::unique_ptr<SceneView>> scene = SceneView::create(device, options);
  if (!scene) return scene.error();
  (*scene)->renderer().foresee_programs();
  return std::unique_ptr<Backdrop>(new Backdrop(*std::move(scene), view));
}

Backdrop::Backdrop(std::unique_ptr<SceneView> view, View kind)
    : view_(std::move(view)), kind_(kind) {
  const render::FixedPos& at = view_->start_camera().position;
  middle_ = {at[0], at[1], at[2]};
  const std::vector<world::IslandSpec> near = view_->world().islands_near(middle_, 0.0, 0.0);
  if (near.empty()) return;
  const double y_blocks = world::difference_blocks(middle_, near.front().origin).y;
  middle_ = world::moved(near.front().origin, {0.0, y_blocks, 0.0});
  distance_ = std::clamp(1.1 * near.front().bounding_radius, kNearest, kFarthest);
}

SceneView::Moment Backdrop::moment() const {
  SceneView::Moment moment;
  moment.camera = view_->start_camera();
  moment.may_lag = true;
  moment.world_time_s = passed_s_;
  moment.time_of_day_s = kMorningS;
  const double turned_deg = kTurnDegPerSecond * passed_s_;
  if (kind_ == View::kSpawn) {
    moment.world_time_s = 0.0;  // the spawn is where it is at the beginning
    moment.camera.yaw_deg += kWindowSide + 12.0 * std::sin(glm::radians(4.0 * turned_deg));
    return moment;
  }
  const double yaw_deg = kStartDeg + turned_deg;
  const double yaw = glm::radians(yaw_deg), pitch = glm::radians(kLookDownDeg);
  const glm::dvec3 back{-std::sin(yaw) * std::cos(pitch), std::sin(pitch),
                        -std::cos(yaw) * std::cos(pitch)};
  const world::WorldPos eye = world::moved(middle_, back * distance_);
  moment.camera.position = {eye.x, eye.y, eye.z};
  moment.camera.yaw_deg = yaw_deg + kWindowSide;
  moment.camera.pitch_deg = -kLookDownDeg;
  return moment;
}

}  // namespace skerry::game
