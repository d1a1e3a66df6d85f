#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "world/voxel/island.h"

namespace skerry::world {

/// Islands that were disturbed move in ticks; tick n is at n / kMotionTicksPerSecond seconds.
inline constexpr int kMotionTicksPerSecond = 60;
inline constexpr double kMotionTickSeconds = 1.0 / kMotionTicksPerSecond;

/// Where a disturbed island was at its last ticks.
class PoseTrack {
 public:
  /// Half a second: more than a frame of play may take.
  static constexpr std::size_t kKept = 32;

  /// @param tick one more than the last; any other begins the track anew.
  void push(std::int64_t tick, const Pose& pose);
  /// Between ticks on the straight way from one to the next; before and after what is kept, at its
  /// ends. @pre something was pushed.
  Pose at(double time_s) const;
  const Pose& newest() const { return poses_[index(newest_)]; }
  bool empty() const { return count_ == 0; }

 private:
  static std::size_t index(std::int64_t tick) {
    return static_cast<std::size_t>(floor_mod(tick, kKept));
  }

  std::array<Pose, kKept> poses_{};
  std::int64_t newest_ = 0;
  std::size_t count_ = 0;
};

}  // namespace skerry::world
