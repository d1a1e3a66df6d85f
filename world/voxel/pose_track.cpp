#include "world/voxel/pose_track.h"

#include <algorithm>
#include <cmath>

#include "engine/core/check.h"

namespace skerry::world {
namespace {

Pose between(const Pose& a, const Pose& b, double alpha) {
  // Not a bit off at a tick, nor while it stands still: however many of its ticks are known.
  if (alpha == 0.0 || (a.origin == b.origin && a.rotation == b.rotation)) return a;
  // A tick turns an island by a fraction of a degree: the straight way between two rotations and
  // the arc differ by less than a double shows.
  glm::dquat to = b.rotation;
  if (glm::dot(a.rotation, to) < 0.0) to = -to;
  const glm::dquat rotation = a.rotation * (1.0 - alpha) + to * alpha;
  return {moved(a.origin, difference_blocks(b.origin, a.origin) * alpha),
          rotation * (1.0 / std::sqrt(glm::dot(rotation, rotation)))};
}

}  // namespace

void PoseTrack::push(std::int64_t tick, const Pose& pose) {
  count_ = count_ != 0 && tick == newest_ + 1 ? std::min(count_ + 1, kKept) : 1;
  newest_ = tick;
  poses_[index(tick)] = pose;
}

Pose PoseTrack::at(double time_s) const {
  SKERRY_ASSERT(count_ != 0);
  const double at = time_s * kMotionTicksPerSecond;
  const std::int64_t oldest = newest_ - static_cast<std::int64_t>(count_) + 1;
  if (!(at < static_cast<double>(newest_))) return newest();
  if (!(at > static_cast<double>(oldest))) return poses_[index(oldest)];
  const auto tick = static_cast<std::int64_t>(std::floor(at));
  return between(poses_[index(tick)], poses_[index(tick + 1)], at - static_cast<double>(tick));
}

}  // namespace skerry::world
