#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "game/player/player.h"
#include "world/voxel/blocks.h"
#include "world/voxel/coords.h"
#include "world/voxel/island.h"

namespace skerry::tools::stability {

/// Surroundings made of functions: islands' poses of time and blocks of voxels. For one thread.
class PlaceToPlay : public game::Surroundings {
 public:
  struct Island {
    std::function<world::Pose(double time_s)> pose;
    std::function<world::BlockId(world::IVec3)> block;
    double radius = 256.0;  ///< blocks about the lattice origin
  };
  explicit PlaceToPlay(Island island) { islands_.push_back(std::move(island)); }

  void islands_near(world::WorldPos place, double radius_blocks, double time_s,
                    std::vector<std::uint64_t>& out) const override;
  std::optional<world::Pose> pose(std::uint64_t island, double time_s) const override;
  std::optional<world::BlockId> block(std::uint64_t island, world::IVec3 voxel) const override;

  /// A place in the first island's lattice.
  glm::dvec3 lattice(world::WorldPos place, double time_s) const;

 private:
  struct Known {
    std::uint64_t island = ~std::uint64_t{0};
    double time_s = 0.0;
    world::Pose pose;
  };
  const world::Pose& pose_of(std::uint64_t island, double time_s) const;

  std::vector<Island> islands_;
  // Of the two ends of a tick, which are asked for several times and cost as much as all the rest.
  mutable std::array<Known, 2> known_;
};

/// A pose that stays, turns about +y at `spin` rad/s and drifts along a circle of 10 blocks at
/// `drift` rad/s.
std::function<world::Pose(double)> moving(double spin, double drift);

/// Volume of a player's box at `feet` inside solids [blocks^3], counted voxel by voxel and
/// independent of the sweep that moves players.
double volume_in_solids(const PlaceToPlay& around, const glm::dvec3& feet);

}  // namespace skerry::tools::stability
