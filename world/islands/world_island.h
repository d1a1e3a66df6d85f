// What World keeps of an island. Private to world/world*.cpp.
#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>

#include "world/islands/world.h"

namespace skerry::world {

struct World::Island {
  explicit Island(const IslandSpec& island_spec,
                  std::shared_ptr<const VoxelSource> voxels = nullptr)
      : added(voxels != nullptr), made(island_spec), source(std::move(voxels)), spec_(made) {}

  /// What the voxels come from; built now if it has to be.
  std::shared_ptr<const VoxelSource> plan();
  /// The ones below take the lock.
  IslandSpec spec() const;
  Pose pose(double time_s) const;
  void apply_edits(IVec3 chunk, int level, std::span<BlockId> padded, bool& any) const;
  bool idle() const;

  // With the lock held.
  const IslandSpec& spec_locked() const { return spec_; }
  /// @return whether the island's box has grown.
  bool put(IVec3 chunk, std::span<const VoxelEdit> edits);

  const bool added;          // its source is all there is of it, and stays
  const IslandSpec made;     // as it came; the seed's voxels follow from it
  std::mutex plan_mutex;     // held while the plan is built
  mutable std::mutex mutex;  // guards everything below; never held for long
  std::shared_ptr<const VoxelSource> source;
  std::map<IVec3, Chunk> chunks;            // loaded, level 0
  std::optional<std::set<IVec3>> may_hold;  // level-0 chunks that are not plain air, if known
  std::map<IVec3, std::shared_ptr<const ChunkEdits>> edits;  // by level-0 chunk; replaced whole
  std::unique_ptr<PoseTrack> track;                          // of an island that was moved
  WorldPos noted;  // where it was when the world's revision last grew

 private:
  IslandSpec spec_;  // `made`, but for a box and a radius that grow with what is built
};

/// Order of lists of chunks: y, then x, then z.
bool by_layers(const IVec3& a, const IVec3& b);
/// Puts edits into a chunk.
void put_into(Chunk& chunk, std::span<const VoxelEdit> edits);

}  // namespace skerry::world
