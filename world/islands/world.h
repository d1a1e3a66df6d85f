#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "world/voxel/chunk.h"
#include "world/voxel/edits.h"
#include "world/voxel/island.h"
#include "world/voxel/pose_track.h"
#include "world/voxel/voxel_source.h"

namespace skerry::world {

struct WorldDesc {
  std::uint64_t seed = 0;
  /// Added to every island's place [blocks, +-kMaxBlock].
  std::array<std::int64_t, 3> offset_blocks{};
  /// Only so many islands exist: the nearest to the world's own origin, which is the offset. None:
  /// all. At most 100,000.
  std::optional<std::uint32_t> island_limit = {};
  /// False: the seed makes no islands; there are those that were added.
  bool generated = true;
};

/// Voxels that were changed.
struct EditedBox {
  std::uint64_t island = 0;
  IVec3 min, max;  ///< lattice places at level 0, both inside
};

/// Where islands are at one time. A copy of what World knew when it was made.
class IslandPoses {
 public:
  /// @param spec as World gives it; also of an island that it has dropped.
  Pose of(const IslandSpec& spec) const;
  /// Whether pose_at() does not place it.
  bool is_off_course(std::uint64_t island) const { return off_course_.contains(island); }

 private:
  friend class World;
  double time_s_ = 0.0;
  std::unordered_map<std::uint64_t, Pose> off_course_;  // those that pose_at does not place
};

/// A seed's islands, islands that no seed made, the voxels of those that are near, and what players
/// changed.
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

  const WorldDesc& desc() const { return desc_; }
  std::uint64_t seed() const { return desc_.seed; }
  /// Where the world's own origin is.
  WorldPos origin() const;
  /// The seed's spawn, moved by the offset; generates the columns it needs. Without a seed's
  /// islands the middle of the largest island, on top.
  Spawn spawn() const;

  /// Adds an island that no seed made, known from now on. @return false: the id is taken.
  bool add_island(const IslandSpec& spec, std::shared_ptr<const VoxelSource> source);
  /// Ids of the islands that were added, ascending.
  std::vector<std::uint64_t> added_islands() const;
  bool is_added(std::uint64_t id) const;
  /// Whether all voxels of an island are those that the seed gives it: not added, without edits.
  bool is_as_generated(std::uint64_t id) const;
  /// Ids of the islands that are not as the seed makes them, ascending: added, moved from their
  /// course, or with edits.
  std::vector<std::uint64_t> changed_islands() const;
  /// An id that no island of this world has. Depends on the seed and the islands added so far.
  std::uint64_t unused_id() const;
  /// Makes an island of the seed known by its id and mean place. @return false: the seed makes none
  /// of that id there.
  bool meet(std::uint64_t id, WorldPos origin);
  /// From now on the island is where it is put, not where pose_at has it. Between ticks it moves
  /// straight (PoseTrack). @return false: no such island is known.
  bool move_island(std::uint64_t id, std::int64_t tick, const Pose& pose);
  /// Grows whenever islands_near may answer otherwise for a reason that is not in its arguments.
  std::uint64_t revision() const { return revision_.load(std::memory_order_acquire); }

  /// Islands whose bounding spheres come within `radius_blocks` of `centre` at a time, nearest
  /// centre first, ties by id. Origins include the offset; pose() is where a moved island is.
  std::vector<IslandSpec> islands_near(WorldPos centre, double radius_blocks, double time_s) const;
  /// Its box and radius grow when blocks are put beyond them. None: no such island is known.
  /// Islands without voxels or edits may be dropped when thousands are held; islands_near makes
  /// them known again.
  std::optional<IslandSpec> island(std::uint64_t id) const;
  std::optional<Pose> pose(std::uint64_t id, double time_s) const;
  /// pose() of many islands, without a look-up and two locks for each.
  IslandPoses poses(double time_s) const;

  /// The block at a level-0 voxel, edits included. None: its chunk is not loaded.
  std::optional<BlockId> block_at(std::uint64_t id, IVec3 voxel) const;
  /// Loads a level-0 chunk now, on this thread. @return false: no such island is known.
  bool ensure_chunk(std::uint64_t id, IVec3 chunk);
  /// Changes a voxel, loaded or not, and reports it to take_edits. @return false: no such island.
  bool set_block(std::uint64_t id, IVec3 voxel, BlockId block);
  /// Changes many voxels of a chunk at once. @param edits ascending indices.
  bool set_blocks(std::uint64_t id, IVec3 chunk, std::span<const VoxelEdit> edits);
  /// What was changed since the last call, in order. For the one who re-meshes.
  std::vector<EditedBox> take_edits();
  /// Chunks of level 0 with edits, ascending, and those edits.
  std::vector<IVec3> edited_chunks(std::uint64_t id) const;
  ChunkEdits edits(std::uint64_t id, IVec3 chunk) const;
  /// A chunk of level 0 as it is now. Generates it if it is not loaded. Air if no such island is
  /// known.
  Chunk chunk_now(std::uint64_t id, IVec3 chunk);

  /// Chunks of an island at a level that can hold blocks, edits included. Order: y, then x, then z.
  /// Builds the island's plan if need be: some 40 ms for a giant, so not for the frame thread.
  std::vector<IVec3> chunks(std::uint64_t id, int level);
  /// VoxelSource::generate_padded with edits applied: a coarse voxel shows an edit that lies at
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
  using IslandMap = std::map<std::uint64_t, std::shared_ptr<Island>>;
  std::shared_ptr<Island> find(std::uint64_t id) const;
  void remember(const std::vector<IslandSpec>& specs) const;
  /// Islands that are not where, or not as large as, the seed has them.
  IslandMap special() const;
  Spawn spawn_on_added() const;

  const WorldDesc desc_;
  std::optional<std::unordered_set<std::uint64_t>> allowed_;  // ids within the limit
  std::atomic<std::uint64_t> revision_ = 0;
  mutable std::mutex islands_mutex_;
  mutable std::unordered_map<std::uint64_t, std::shared_ptr<Island>> islands_;
  IslandMap special_;  // added, or moved from where pose_at has them; never dropped
  IslandMap grown_;    // with blocks beyond the box that the seed gives them; never dropped
  std::mutex edits_mutex_;
  std::vector<EditedBox> edits_;
};

/// No island drifts further than this from its mean place [blocks].
inline constexpr double kMaxIslandDriftBlocks = 16.0;

/// The inner voxels of a padded chunk (IslandGenerator::generate_padded).
Chunk chunk_from_padded(std::span<const BlockId> padded);

}  // namespace skerry::world
