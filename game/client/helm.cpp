#include "game/client/helm.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "game/client/island_name.h"
#include "game/words/words.h"

namespace skerry::game {
namespace {

// An island that is driven and slower than these is held; engines bring it beyond them in 0.1 s.
constexpr double kHeldSpeed = 0.05;                   // blocks/s
constexpr double kHeldTurn = 1e-12;                   // 1 - cos of half the angle of a frame
constexpr double kHeldAfter = 0.6, kBumpSpeed = 1.5;  // seconds; blocks/s
// One that strains against a corner jerks now and then, for a tick and by some thousandths of a
// block. It is free when it goes on for longer than that, or farther.
constexpr double kJerkSeconds = 0.05, kJerkBlocks = 0.03;
constexpr int kJerkFrames = 2;

}  // namespace

bool Helm::held_fast() const {
  return held_s_ >= kHeldAfter;
}

void Helm::take(std::uint64_t island) {
  *this = {};
  island_ = island;
}

void Helm::leave(SessionClient& session) {
  if (island_) session.send(Steer{*island_, {}, 0.0});
  *this = {};
}

void Helm::steer(const Intent& intent, double yaw_deg, SessionClient& session) {
  if (!island_) return;
  const double yaw = glm::radians(yaw_deg);
  const glm::dvec3 ahead{std::sin(yaw), 0.0, std::cos(yaw)};
  // What only waits is not held by another island.
  driven_ = (intent.move != glm::dvec2(0.0) || intent.rise != 0.0) && !session.waits(*island_);
  session.send(
      Steer{*island_, ahead * intent.move.y + glm::dvec3{0.0, intent.rise, 0.0}, -intent.move.x});
}

/// Told by the island's place: one that another bars the way keeps the speed that its engines gave
/// it, and stays where it is.
std::optional<std::string> Helm::watch(const world::Pose& before, const world::Pose& now,
                                       double seconds) {
  bump_ = 0.0;
  if (!island_ || seconds <= 0.0) return std::nullopt;
  const double was = speed_;
  const bool was_held = held_fast();
  speed_ = glm::length(world::difference_blocks(now.origin, before.origin)) / seconds;
  const double turned = 1.0 - std::abs(glm::dot(now.rotation, before.rotation));
  const bool stands = speed_ < kHeldSpeed && turned < kHeldTurn;
  moves_s_ = stands ? 0.0 : moves_s_ + seconds;
  move_frames_ = stands ? 0 : move_frames_ + 1;
  const bool goes_on = move_frames_ > kJerkFrames && moves_s_ > kJerkSeconds;
  const bool about_there = stands_at_ && glm::length(world::difference_blocks(
                                             now.origin, stands_at_->origin)) < kJerkBlocks;
  if (driven_ && about_there && !goes_on) {
    held_s_ += seconds;
  } else {
    held_s_ = 0.0;
    stands_at_ = now;
  }
  if (was > kBumpSpeed && speed_ < 0.25 * was) bump_ = was;
  if (held_fast() && !was_held)
    return tr_format("{} is held fast by another island: back off, rise or turn",
                     island_name(*island_));
  if (bump_ > 0.0)
    return tr_format("{} bumped into something at {:.0f} blocks/s", island_name(*island_), bump_);
  return std::nullopt;
}

}  // namespace skerry::game
