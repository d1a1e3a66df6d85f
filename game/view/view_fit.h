#pragma once
#include <cstdint>
#include <optional>

#include "world/voxel/coords.h"

namespace skerry::game {

/// How far and how finely the world is shown when memory does not hold all that the settings ask
/// for: the finest level gives way first, then the distance. A function of its calls; there
/// is no clock in it.
class ViewFit {
 public:
  struct Distances {
    double view_blocks = 0.0;    ///< nothing farther is shown
    double detail_blocks = 0.0;  ///< full detail up to here
    bool operator==(const Distances&) const = default;
  };

  /// What to show of what the settings ask for.
  Distances of(const Distances& asked) const;
  /// Memory ran out with the present distances. @return false: they cannot be lowered further.
  bool lower(const Distances& asked, const world::WorldPos& camera);
  /// Called once a frame with everything in place. @param used share of the memory, 0..1. May raise
  /// the distances again: after kCalmFrames frames in a row below kRoomy, and to a step at which
  /// memory ran out only once the camera has gone a quarter of the view distance from there.
  void settled(double used, const Distances& asked, const world::WorldPos& camera);

  static constexpr double kStep = 0.8;    ///< each step's share of the distance before
  static constexpr double kLeast = 32.0;  ///< blocks, of either distance
  static constexpr double kRoomy = 0.5;
  static constexpr int kCalmFrames = 60;

 private:
  int step_ = 0, calm_frames_ = 0;
  struct RanOut {
    int step;
    world::WorldPos camera;
  };
  std::optional<RanOut> ran_out_;  // the highest step that is known to be too much, and where
};

}  // namespace skerry::game
