#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "world/chunk.h"
#include "world/island.h"

namespace skerry::world {

class IslandGenerator;

struct WorldDesc {
  std::uint64_t seed = 0;
  /// Added to every island's place [blocks, +-kMaxBlock].
  std::array<std::int64_t, 3> offset_blocks{};
  /// Only so many islands exist: the nearest to the world's own origin, which is the offset. None:
  /// all. At most 100,000.
  std::optional<std::uint32_t> island_limit = {};
};

/// A block that set_block changed.
struct BlockEdit {
  std::uint64_t island = 0;
  IVec3 voxel;  ///< lattice place at level 0
};

/// A seed's islands, the voxels of those that are near, and what players changed.
///
/// An island is known by id from the moment islands_near has named it. All members may be called
/// from any thread at any time; none of those that a frame calls waits for generation, ensure_chunk
/// aside. One lock guards the list of islands, one more each island's voxels; both are held for
/// look-ups and moves only, never while voxels or plans are generated.
class World {
 public:
  explicit World(const WorldDesc& desc);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  std::uint64_t seed() const { return desc_.seed; }
  /// Where the world's own origin is.
  WorldPos origin() const;
  /// The seed's spawn, moved by the offset. Generates the columns it needs.
  Spawn spawn() const;

  /// Islands whose bounding spheres come within `radius_blocks` of `centre` at a time, nearest
  /// centre first, ties by id. Origins include the offset.
  std::vector<IslandSpec> islands_near(WorldPos centre, double radius_blocks, double time_s) const;
  /// None: no such island is known. Islands without voxels or edits may be forgotten when thousands
  /// are known; islands_near makes them known again.
  std::optional<IslandSpec> island(std::uint64_t id) const;
  std::optional<Pose> pose(std::uint64_t id, double time_s) const;

  /// The block at a level-0 voxel, edits included. None: its chunk is not loaded.
  std::optional<BlockId> block_at(std::uint64_t id, IVec3 voxel) const;
  /// Loads a level-0 chunk now, on this thread. @return false: no such island is known.
  bool ensure_chunk(std::uint64_t id, IVec3 chunk);
  /// Changes a voxel, loaded or not, and reports it to take_edits. @return false: no such island.
  bool set_block(std::uint64_t id, IVec3 voxel, BlockId block);
  /// What set_block changed since the last call, in order. For the one who re-meshes.
  std::vector<BlockEdit> take_edits();

  /// Chunks of an island at a level that can hold blocks, edits included. Order: y, then x, then z.
  /// Builds the island's plan if need be: seconds of work for a giant, so not for the frame thread.
  std::vector<IVec3> chunks(std::uint64_t id, int level);
  /// IslandGenerator::generate_padded with edits applied: a coarse voxel shows an edit that lies at
  /// its centre, as it shows the generated block there. All air when no such island is known.
  bool generate_padded(std::uint64_t id, IVec3 chunk, int level, std::span<BlockId> out);
  /// Loads a chunk that chunk_from_padded has made; edits that came meanwhile are added.
  void keep_chunk(std::uint64_t id, IVec3 at, Chunk chunk);
  /// Drops what was generated of an island and can be generated again; edits stay.
  void release_voxels(std::uint64_t id);
  void release_plan(std::uint64_t id);

  /// What the loaded voxels take.
  struct Usage {
    std::size_t islands = 0;  ///< known
    std::size_t chunks = 0;   ///< loaded, of level 0
    std::size_t bytes = 0;    ///< of those chunks
  };
  Usage usage() const;

 private:
  struct Island;
  std::shared_ptr<Island> find(std::uint64_t id) const;
  void know(const std::vector<IslandSpec>& specs) const;

  const WorldDesc desc_;
  std::optional<std::unordered_set<std::uint64_t>> allowed_;  // ids within the limit
  mutable std::mutex islands_mutex_;
  mutable std::unordered_map<std::uint64_t, std::shared_ptr<Island>> islands_;
  std::mutex edits_mutex_;
  std::vector<BlockEdit> edits_;
};

/// No island drifts further than this from its mean place [blocks].
inline constexpr double kMaxIslandDriftBlocks = 16.0;

/// The inner voxels of a padded chunk (IslandGenerator::generate_padded).
Chunk chunk_from_padded(std::span<const BlockId> padded);

/// Chunk that holds a voxel, and the voxel's place in it.
IVec3 chunk_of(IVec3 voxel);
std::size_t index_in_chunk(IVec3 voxel);

}  // namespace skerry::world
