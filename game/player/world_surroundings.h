#pragma once
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <vector>

#include "game/player/edit_history.h"
#include "game/player/player.h"
#include "world/islands/world.h"

namespace skerry::game {

/// Loads level-0 chunks on a thread of its own. Not on jobs: there they would queue behind all that
/// is still to be meshed, and the player waits for the ground.
class ChunkLoader {
 public:
  /// @param world outlives this.
  explicit ChunkLoader(world::World& world);
  ~ChunkLoader();  ///< finishes the current chunk, drops the others
  ChunkLoader(const ChunkLoader&) = delete;
  ChunkLoader& operator=(const ChunkLoader&) = delete;

  /// Queues a chunk unless it is waiting already.
  void request(std::uint64_t island, world::IVec3 chunk);

 private:
  struct Task {
    std::uint64_t island;
    world::IVec3 chunk;
    auto operator<=>(const Task&) const = default;
  };
  void work();

  world::World& world_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Task> queue_;
  std::set<Task> waiting_;  // queued or current
  bool stop_ = false;
  std::thread thread_;
};

/// A world as the player collides with it. The islands around are looked up once a frame; the
/// chunks next to the player are loaded, so that there is ground even where nothing has been meshed
/// yet.
class WorldSurroundings : public Surroundings {
 public:
  /// @param world outlives this.
  explicit WorldSurroundings(world::World& world) : world_(world), loader_(world) {}

  /// Call once a frame, before the ticks. @param reach_blocks how far the player may get until the
  /// next call.
  void refresh(world::WorldPos place, double reach_blocks, double time_s);

  void islands_near(world::WorldPos place, double radius_blocks, double time_s,
                    std::vector<std::uint64_t>& out) const override;
  std::optional<world::Pose> pose(std::uint64_t island, double time_s) const override;
  std::optional<world::BlockId> block(std::uint64_t island, world::IVec3 voxel) const override;

 private:
  world::Pose pose_of(const world::IslandSpec& spec, double time_s) const;
  const world::IslandSpec* spec_of(std::uint64_t island) const;
  void load_chunks(const world::IslandSpec& spec, world::WorldPos place, double time_s);

  world::World& world_;
  std::vector<world::IslandSpec> islands_;  // ascending ids
  ChunkLoader loader_;
};

/// Edits straight into a world.
class WorldEditor : public BlockEditor {
 public:
  /// @param world outlives this.
  explicit WorldEditor(world::World& world) : world_(world) {}
  bool set_block(std::uint64_t island, world::IVec3 voxel, world::BlockId block) override {
    return world_.set_block(island, voxel, block);
  }

 private:
  world::World& world_;
};

}  // namespace skerry::game
