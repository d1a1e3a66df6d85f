#include "game/player/player.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace skerry::game {
namespace {

// Islands turn about +y only (world::IslandSpec), so "up" and gravity are the same in every
// lattice.

constexpr double kFallSpeedLimit = 80.0;  // blocks/s
constexpr double kWalkSpeed = 4.5, kSprintSpeed = 8.0, kSwimSpeed = 2.5, kCrouchSpeed = 1.5;
constexpr double kSwimRise = 3.5, kSink = -1.5;  // blocks/s, with and without stroke
constexpr double kGroundGrip = 12.0, kAirGrip = 2.0, kWaterGrip = 5.0, kFlyGrip = 8.0;  // 1/s
constexpr double kFastFlight = 5.0;  // times the flying speed
constexpr double kReach = 16.0;      // blocks beyond an island's sphere in which its frame is kept
constexpr int kMaxPushOut = 256;     // blocks upwards
constexpr double kEyeRate = 14.0;    // 1/s, at which the eye comes to its height
constexpr std::size_t kSafePlaces = 8;
constexpr std::int64_t kSafeSpacing = 3 * kLatticeBlock;  // between them, along an axis

LatticePos to_lattice(const world::Pose& pose, world::WorldPos place) {
  return lattice_pos(glm::conjugate(pose.rotation) * world::difference_blocks(place, pose.origin));
}

world::WorldPos to_world(const world::Pose& pose, const LatticePos& lattice) {
  return world::moved(pose.origin, pose.rotation * lattice_blocks(lattice));
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
    : pitch_deg_(std::clamp(pitch_deg, -90.0, 90.0)),
      start_feet_(feet),
      fall_from_y_(feet.y),
      start_s_(time_s) {
  now_.feet = feet;
  now_.yaw_deg = yaw_deg;
  before_ = now_;
}

Player::Player(const PlayerState& state, double time_s)
    : Player(state.feet, state.yaw_deg, state.pitch_deg, time_s) {
  now_.island = state.island;
  now_.lattice = state.lattice;
  before_ = now_;
  velocity_ = state.velocity;
  mode_ = static_cast<MoveMode>(state.mode);
  set_fly_speed(state.fly_speed);
  if (state.safe) safe_.push_back(*state.safe);
}

PlayerState Player::state() const {
  return {now_.feet,
          now_.island,
          now_.lattice,
          velocity_,
          now_.yaw_deg,
          pitch_deg_,
          static_cast<std::uint8_t>(mode_),
          fly_speed_,
          safe_.empty() ? std::nullopt : std::optional(safe_.back())};
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
    const glm::dvec3 before = lattice_blocks(before_.lattice);
    const glm::dvec3 step = lattice_blocks(now_.lattice - before_.lattice);
    eye.position = world::moved(pose->origin, pose->rotation * (before + step * alpha));
  } else {
    const glm::dvec3 step = world::difference_blocks(now_.feet, before_.feet);
    eye.position = world::moved(before_.feet, step * alpha);
  }
  if (pose) eye.yaw_deg += heading_deg(*pose);
  eye.yaw_deg = std::remainder(eye.yaw_deg, 360.0);
  const double lag = glm::mix(before_.eye_lag, now_.eye_lag, alpha);
  eye.position = world::moved(eye.position, {0.0, kEyeHeight - lag, 0.0});
  return eye;
}

double Player::return_fade() const {
  if (returns_ == 0) return 0.0;
  const double since_s = static_cast<double>(ticks_ - returned_tick_) * kTickSeconds + owed_s_;
  return std::max(0.0, 1.0 - since_s / kReturnFade);
}

void Player::tick(const Intent& intent, const Surroundings& around) {
  before_ = now_;
  find_movers(around);
  leave_lost_frame(around);
  if (mode_ != MoveMode::kNoclip) leave_solids(around);
  crouching_ = intent.crouch && mode_ == MoveMode::kWalk;
  climbing_ = mode_ == MoveMode::kWalk && (on_ground_ || in_water_) &&
              !(intent.jump && !in_water_) && intent.move != glm::dvec2(0.0);
  update_velocity(intent);
  Place target = wanted_place(around);
  on_ground_ = false;
  risen_ = 0.0;
  if (mode_ != MoveMode::kNoclip) collide_all(around, target);
  now_ = target;
  ++ticks_;
  look_for_water(around);
  lower_eye();
  note_safe_ground(around);
  if (is_lost(around)) come_back(around);
}

void Player::collide_all(const Surroundings& around, Place& target) {
  // Being stopped by one island can push into another; a few rounds settle it. What is left,
  // leave_solids resolves.
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    bool touched = false;
    for (const Mover& mover : movers_) touched |= collide(around, mover, target, round > 0);
    if (!touched || movers_.size() == 1) break;
  }
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

glm::dvec3 Player::Mover::carry(const LatticePos& lattice) const {
  const glm::dvec3 at = lattice_blocks(lattice);
  const glm::dvec3 drift = world::difference_blocks(to.origin, from.origin);
  return (drift + to.rotation * at - from.rotation * at) * double{kTicksPerSecond};
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
    LatticePos lattice =
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
  if (mode_ != MoveMode::kWalk) {
    wish.y = std::clamp(intent.rise, -1.0, 1.0);
    const double length = std::max(1.0, glm::length(wish));
    const double speed = std::min(fly_speed_ * (intent.fast ? kFastFlight : 1.0), kMaxFlySpeed);
    wish *= speed / length;
    for (int axis = 0; axis < 3; ++axis)
      velocity_[axis] = approach(velocity_[axis], wish[axis], kFlyGrip);
  } else {
    const double speed = in_water_     ? kSwimSpeed
                         : crouching_  ? kCrouchSpeed
                         : intent.fast ? kSprintSpeed
                                       : kWalkSpeed;
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

Player::Place Player::wanted_place(const Surroundings& around) {
  Place place = now_;
  const glm::dvec3 step = velocity_ * kTickSeconds;
  const Mover* frame = mover_of(now_.island);
  if (!frame) {
    place.feet = world::moved(now_.feet, step);
    return place;
  }
  LatticePos motion = lattice_pos(step);
  if (crouching_ && on_ground_ && velocity_.y <= 0.0) {
    const LatticePos kept =
        keep_on_edge(solid_query(around, frame->island, true), now_.lattice, motion);
    for (const int axis : {0, 2})
      if (kept[axis] != motion[axis]) velocity_[axis] = 0.0;
    motion = kept;
  }
  place.lattice += motion;
  place.feet = to_world(frame->to, place.lattice);
  return place;
}

bool Player::collide(const Surroundings& around, const Mover& mover, Place& target,
                     bool only_if_inside) {
  const bool in_frame = target.island == mover.island;
  const LatticePos from =
      now_.island == mover.island ? now_.lattice : to_lattice(mover.from, now_.feet);
  const LatticePos to = in_frame ? target.lattice : to_lattice(mover.to, target.feet);
  const SolidQuery solid = solid_query(around, mover.island, mode_ == MoveMode::kWalk);
  if (only_if_inside && !box_overlaps(solid, to)) return false;
  const SweepResult sweep =
      climbing_ ? climb_box(solid, from, to - from) : sweep_box(solid, from, to - from);
  if (sweep.blocked == glm::ivec3(0)) return false;
  risen_ = std::max(risen_, lattice_blocks(sweep.feet - from).y);

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
    glm::dvec3 middle = lattice_blocks(
        now_.island == mover.island ? now_.lattice : to_lattice(mover.to, now_.feet));
    middle.y += kPlayerHeight / 2.0;
    const glm::ivec3 voxel = glm::floor(middle);
    return around.block(mover.island, {voxel.x, voxel.y, voxel.z}) == world::block::kWater;
  });
}

void Player::lower_eye() {
  // What falls and jumps do is motion, which the eye takes part in; only steps jolt.
  constexpr double kJolt = 0.25;  // blocks in a tick
  if (climbing_ && risen_ > kJolt) now_.eye_lag += risen_;
  now_.eye_lag = approach(now_.eye_lag, crouching_ ? kCrouchDepth : 0.0, kEyeRate);
}

void Player::note_safe_ground(const Surroundings& around) {
  if (on_ground_ || in_water_ || mode_ != MoveMode::kWalk) fall_from_y_ = now_.feet.y;
  if (!on_ground_ || mode_ != MoveMode::kWalk || !now_.island) return;
  if (!safe_.empty() && safe_.back().island == *now_.island) {
    const LatticePos away = glm::abs(now_.lattice - safe_.back().lattice);
    if (std::max({away.x, away.y, away.z}) < kSafeSpacing) return;
  }
  // Not with one foot over an edge: the voxel under the middle must hold.
  const glm::ivec3 below = glm::floor(lattice_blocks(now_.lattice) - glm::dvec3(0.0, 0.5, 0.0));
  const auto block = around.block(*now_.island, {below.x, below.y, below.z});
  if (!block || !world::is_solid(*block)) return;
  safe_.push_back({*now_.island, now_.lattice});
  if (safe_.size() > kSafePlaces) safe_.pop_front();
}

bool Player::is_lost(const Surroundings& around) const {
  if (on_ground_ || in_water_ || mode_ != MoveMode::kWalk) return false;
  const double fallen = static_cast<double>(fall_from_y_ - now_.feet.y) / world::kUnitsPerBlock;
  if (fallen < kLostDepth) return false;
  std::vector<std::uint64_t> near;
  around.islands_near(now_.feet, kRescueRadius, tick_time_s(), near);
  return near.empty() || fallen > kDeepestFall;
}

/// @return whether that ground is still there; then the place is on it.
bool Player::stand_on(const Footing& ground, const Surroundings& around, Place& place) const {
  const auto pose = around.pose(ground.island, tick_time_s());
  if (!pose || !is_supported(solid_query(around, ground.island, true), ground.lattice))
    return false;
  place.island = ground.island;
  place.lattice = ground.lattice;
  place.feet = to_world(*pose, ground.lattice);
  place.yaw_deg -= heading_deg(*pose);
  return true;
}

/// The present place in no island's frame.
Player::Place Player::away_from_frame(const Surroundings& around) const {
  Place place = now_;
  if (const auto pose = now_.island ? around.pose(*now_.island, tick_time_s()) : std::nullopt)
    place.yaw_deg += heading_deg(*pose);
  place.island.reset();
  place.eye_lag = 0.0;
  return place;
}

void Player::come_to_rest(const Place& place) {
  now_ = before_ = place;
  fall_from_y_ = now_.feet.y;
  velocity_ = {};
}

bool Player::stand_on(const Footing& ground, const Surroundings& around) {
  Place place = away_from_frame(around);
  if (!stand_on(ground, around, place)) return false;
  mode_ = MoveMode::kWalk;
  come_to_rest(place);
  return true;
}

void Player::fly_to(world::WorldPos feet, const Surroundings& around) {
  Place place = away_from_frame(around);
  place.feet = feet;
  if (mode_ == MoveMode::kWalk) mode_ = MoveMode::kFly;
  come_to_rest(place);
}

/// To the last ground that is still there, else to where it all began.
void Player::come_back(const Surroundings& around) {
  Place place = away_from_frame(around);
  place.feet = start_feet_;
  while (!safe_.empty() && !stand_on(safe_.back(), around, place)) safe_.pop_back();
  if (safe_.empty() && home_) stand_on(*home_, around, place);
  come_to_rest(place);
  ++returns_;
  returned_tick_ = ticks_;
}

}  // namespace skerry::game
