#include "game/player.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace skerry::game {
namespace {

// Islands turn about +y only (world::IslandSpec), so "up" and gravity are the same in every
// lattice.

constexpr double kFallSpeedLimit = 80.0;                                  // blocks/s
constexpr double kWalkSpeed = 4.5, kSprintSpeed = 8.0, kSwimSpeed = 2.5;  // blocks/s
constexpr double kSwimRise = 3.5, kSink = -1.5;  // blocks/s, with and without stroke
constexpr double kGroundGrip = 12.0, kAirGrip = 2.0, kWaterGrip = 5.0, kFlyGrip = 8.0;  // 1/s
constexpr double kFastFlight = 5.0;  // times the flying speed
constexpr double kReach = 16.0;      // blocks beyond an island's sphere in which its frame is kept
constexpr int kMaxPushOut = 256;     // blocks upwards

glm::dvec3 to_lattice(const world::Pose& pose, world::WorldPos place) {
  return glm::conjugate(pose.rotation) * world::difference_blocks(place, pose.origin);
}

world::WorldPos to_world(const world::Pose& pose, const glm::dvec3& lattice) {
  return world::moved(pose.origin, pose.rotation * lattice);
}

double heading_deg(const world::Pose& pose) {
  const glm::dvec3 ahead = pose.rotation * glm::dvec3(0.0, 0.0, 1.0);
  return glm::degrees(std::atan2(ahead.x, ahead.z));
}

/// Moves `value` towards `target` at `rate` a second; implicit Euler, so that no rate overshoots.
double approach(double value, double target, double rate) {
  return value + (target - value) * (rate * kTickSeconds / (1.0 + rate * kTickSeconds));
}

/// Horizontal wish of at most length 1 in the axes that yaw is measured in.
glm::dvec3 horizontal_wish(glm::dvec2 move, double yaw_deg) {
  const double length = glm::length(move);
  if (length > 1.0) move /= length;
  const double yaw = glm::radians(yaw_deg);
  const glm::dvec3 forward{std::sin(yaw), 0.0, std::cos(yaw)};
  const glm::dvec3 right{-std::cos(yaw), 0.0, std::sin(yaw)};
  return right * move.x + forward * move.y;
}

}  // namespace

Player::Player(world::WorldPos feet, double yaw_deg, double pitch_deg, double time_s)
    : pitch_deg_(std::clamp(pitch_deg, -90.0, 90.0)), start_s_(time_s) {
  now_.feet = feet;
  now_.yaw_deg = yaw_deg;
  before_ = now_;
}

void Player::turn(double yaw_deg, double pitch_deg) {
  // Both ends of the interpolation turn, so that the view follows the mouse within the frame.
  now_.yaw_deg = std::remainder(now_.yaw_deg + yaw_deg, 360.0);
  before_.yaw_deg = now_.yaw_deg;
  pitch_deg_ = std::clamp(pitch_deg_ + pitch_deg, -90.0, 90.0);
}

void Player::set_fly_speed(double speed) {
  fly_speed_ = std::clamp(speed, kMinFlySpeed, kMaxFlySpeed);
}

void Player::advance(double seconds, const Intent& intent, const Surroundings& around) {
  owed_s_ += seconds;
  while (owed_s_ >= kTickSeconds) {
    owed_s_ -= kTickSeconds;
    tick(intent, around);
  }
}

double Player::world_time_s() const {
  return ticks_ == 0 ? start_s_ : time_of(ticks_ - 1) + owed_s_;
}

CameraPlace Player::eye(const Surroundings& around) const {
  const double alpha = ticks_ == 0 ? 0.0 : owed_s_ * kTicksPerSecond;
  CameraPlace eye{now_.feet, now_.yaw_deg, pitch_deg_};
  const auto pose = now_.island ? around.pose(*now_.island, world_time_s()) : std::nullopt;
  if (pose && before_.island == now_.island) {
    // In the lattice: someone standing still does not move against the ground, however it turns.
    eye.position = to_world(*pose, glm::mix(before_.lattice, now_.lattice, alpha));
  } else {
    const glm::dvec3 step = world::difference_blocks(now_.feet, before_.feet);
    eye.position = world::moved(before_.feet, step * alpha);
  }
  if (pose) eye.yaw_deg += heading_deg(*pose);
  eye.yaw_deg = std::remainder(eye.yaw_deg, 360.0);
  eye.position = world::moved(eye.position, {0.0, kEyeHeight, 0.0});
  return eye;
}

void Player::tick(const Intent& intent, const Surroundings& around) {
  before_ = now_;
  find_movers(around);
  leave_lost_frame(around);
  leave_solids(around);
  update_velocity(intent);
  Place target = wanted_place();
  on_ground_ = false;
  // Being stopped by one island can push into another; a few rounds settle it. What is left,
  // leave_solids resolves.
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    bool touched = false;
    for (const Mover& mover : movers_) touched |= collide(around, mover, target, round > 0);
    if (!touched || movers_.size() == 1) break;
  }
  now_ = target;
  ++ticks_;
  look_for_water(around);
}

void Player::find_movers(const Surroundings& around) {
  // Islands within a tick's travel, and those whose frame is kept.
  const double reach = kReach + glm::length(velocity_) * kTickSeconds;
  around.islands_near(now_.feet, reach, tick_time_s(), near_);
  movers_.clear();
  for (const std::uint64_t island : near_) {
    const auto from = around.pose(island, time_of(ticks_));
    const auto to = around.pose(island, time_of(ticks_ + 1));
    if (from && to) movers_.push_back({island, *from, *to});
  }
}

const Player::Mover* Player::mover_of(std::optional<std::uint64_t> island) const {
  const auto found = std::find_if(movers_.begin(), movers_.end(),
                                  [&](const Mover& mover) { return mover.island == island; });
  return found == movers_.end() ? nullptr : &*found;
}

glm::dvec3 Player::Mover::carry(const glm::dvec3& lattice) const {
  const glm::dvec3 drift = world::difference_blocks(to.origin, from.origin);
  return (drift + to.rotation * lattice - from.rotation * lattice) * double{kTicksPerSecond};
}

void Player::leave_lost_frame(const Surroundings& around) {
  if (!now_.island || mover_of(now_.island)) return;
  const auto from = around.pose(*now_.island, time_of(ticks_));
  const auto to = around.pose(*now_.island, time_of(ticks_ + 1));
  if (from && to) {
    velocity_ = from->rotation * velocity_ + Mover{*now_.island, *from, *to}.carry(now_.lattice);
    now_.yaw_deg += heading_deg(*from);
  }
  now_.island.reset();
}

void Player::leave_solids(const Surroundings& around) {
  for (const Mover& mover : movers_) {
    glm::dvec3 lattice =
        now_.island == mover.island ? now_.lattice : to_lattice(mover.from, now_.feet);
    const SolidQuery solid = solid_query(around, mover.island, false);
    if (!box_overlaps(solid, lattice) || !push_out(solid, lattice, kMaxPushOut)) continue;
    velocity_ = {};
    now_.feet = to_world(mover.from, lattice);
    if (const Mover* frame = mover_of(now_.island))
      now_.lattice = to_lattice(frame->from, now_.feet);
    if (now_.island == mover.island) now_.lattice = lattice;
  }
}

void Player::update_velocity(const Intent& intent) {
  glm::dvec3 wish = horizontal_wish(intent.move, now_.yaw_deg);
  if (mode_ == MoveMode::kFly) {
    wish.y = std::clamp(intent.rise, -1.0, 1.0);
    const double length = std::max(1.0, glm::length(wish));
    const double speed = std::min(fly_speed_ * (intent.fast ? kFastFlight : 1.0), kMaxFlySpeed);
    wish *= speed / length;
    for (int axis = 0; axis < 3; ++axis)
      velocity_[axis] = approach(velocity_[axis], wish[axis], kFlyGrip);
  } else {
    const double speed = in_water_ ? kSwimSpeed : intent.fast ? kSprintSpeed : kWalkSpeed;
    const double grip = in_water_ ? kWaterGrip : on_ground_ ? kGroundGrip : kAirGrip;
    velocity_.x = approach(velocity_.x, wish.x * speed, grip);
    velocity_.z = approach(velocity_.z, wish.z * speed, grip);
    if (in_water_) {
      velocity_.y = approach(velocity_.y, intent.jump ? kSwimRise : kSink, kWaterGrip);
    } else {
      if (intent.jump && on_ground_) velocity_.y = kJumpSpeed;
      velocity_.y = std::max(velocity_.y - kGravity * kTickSeconds, -kFallSpeedLimit);
    }
  }
  // Friction alone only approaches rest.
  constexpr double kRestSpeed = 1e-4;
  if (wish == glm::dvec3(0.0) && std::hypot(velocity_.x, velocity_.z) < kRestSpeed) {
    velocity_.x = velocity_.z = 0.0;
  }
}

Player::Place Player::wanted_place() const {
  Place place = now_;
  const glm::dvec3 step = velocity_ * kTickSeconds;
  if (const Mover* frame = mover_of(now_.island)) {
    place.lattice += step;
    place.feet = to_world(frame->to, place.lattice);
  } else {
    place.feet = world::moved(now_.feet, step);
  }
  return place;
}

bool Player::collide(const Surroundings& around, const Mover& mover, Place& target,
                     bool only_if_inside) {
  const bool in_frame = target.island == mover.island;
  const glm::dvec3 from =
      now_.island == mover.island ? now_.lattice : to_lattice(mover.from, now_.feet);
  const glm::dvec3 to = in_frame ? target.lattice : to_lattice(mover.to, target.feet);
  const SolidQuery solid = solid_query(around, mover.island, mode_ == MoveMode::kWalk);
  if (only_if_inside && !box_overlaps(solid, to)) return false;
  const SweepResult sweep = sweep_box(solid, from, to - from);
  if (sweep.blocked == glm::ivec3(0)) return false;

  // What is left of the motion, seen from this island.
  const Mover* frame = mover_of(target.island);
  glm::dvec3 velocity = velocity_;
  if (!in_frame) {
    const glm::dvec3 in_world =
        frame ? frame->to.rotation * velocity_ + frame->carry(target.lattice) : velocity_;
    velocity = glm::conjugate(mover.to.rotation) * (in_world - mover.carry(to));
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (velocity[axis] * sweep.blocked[axis] > 0.0) velocity[axis] = 0.0;
  }
  const bool landed = sweep.blocked.y < 0;
  on_ground_ |= landed;
  target.feet = to_world(mover.to, sweep.feet);
  if (in_frame || landed || !frame) {
    // From here on the player belongs to this island.
    if (!in_frame) target.yaw_deg += (frame ? heading_deg(frame->to) : 0.0) - heading_deg(mover.to);
    target.island = mover.island;
    target.lattice = sweep.feet;
    velocity_ = velocity;
  } else {
    const glm::dvec3 in_world = mover.to.rotation * velocity + mover.carry(sweep.feet);
    target.lattice = to_lattice(frame->to, target.feet);
    velocity_ = glm::conjugate(frame->to.rotation) * (in_world - frame->carry(target.lattice));
  }
  return true;
}

SolidQuery Player::solid_query(const Surroundings& around, std::uint64_t island,
                               bool hold_at_unknown) const {
  return [&around, island, hold_at_unknown](world::IVec3 voxel) {
    const auto id = around.block(island, voxel);
    return id ? world::is_solid(*id) : hold_at_unknown;
  };
}

void Player::look_for_water(const Surroundings& around) {
  in_water_ = std::any_of(movers_.begin(), movers_.end(), [&](const Mover& mover) {
    glm::dvec3 middle =
        now_.island == mover.island ? now_.lattice : to_lattice(mover.to, now_.feet);
    middle.y += kPlayerHeight / 2.0;
    const glm::ivec3 voxel = glm::floor(middle);
    return around.block(mover.island, {voxel.x, voxel.y, voxel.z}) == world::block::kWater;
  });
}

}  // namespace skerry::game
