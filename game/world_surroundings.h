#pragma once
#include <cstdint>
#include <mutex>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "engine/core/jobs.h"
#include "game/player.h"
#include "world/world.h"

namespace skerry::game {

/// A world as the player meets it. The islands around are looked up once a frame; the chunks next
/// to the player are loaded on a thread of their own, so that there is ground even where nothing
/// has been meshed yet.
class WorldSurroundings : public Surroundings {
 public:
  /// @param world outlives this.
  explicit WorldSurroundings(world::World& world) : world_(world), loader_(1) {}
  ~WorldSurroundings() override { loader_.wait(); }

  /// Call once a frame, before the ticks. @param reach_blocks how far the player may get until the
  /// next call.
  void refresh(world::WorldPos place, double reach_blocks, double time_s);

  void islands_near(world::WorldPos place, double radius_blocks, double time_s,
                    std::vector<std::uint64_t>& out) const override;
  std::optional<world::Pose> pose(std::uint64_t island, double time_s) const override;
  std::optional<world::BlockId> block(std::uint64_t island, world::IVec3 voxel) const override;

 private:
  const world::IslandSpec* spec_of(std::uint64_t island) const;
  void load_chunks(const world::IslandSpec& spec, world::WorldPos place, double time_s);

  world::World& world_;
  std::vector<world::IslandSpec> islands_;  // ascending ids
  std::mutex loading_mutex_;
  std::set<std::pair<std::uint64_t, world::IVec3>> loading_;
  Jobs loader_;  // last: its jobs touch the members above
};

}  // namespace skerry::game
