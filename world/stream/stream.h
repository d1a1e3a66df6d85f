#pragma once
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/core/jobs.h"
#include "world/islands/world.h"
#include "world/mesh/emitters.h"
#include "world/mesh/mesh.h"
#include "world/mesh/occupancy.h"
#include "world/mesh/seams.h"

namespace skerry::world {

/// Islands kept at once, the nearest: what their renderer can name (shared::kMaxIslands), less
/// those on the way out.
inline constexpr std::size_t kMaxStreamedIslands = 64'000;

/// An island at one of its levels: what has a row of the renderer's island table.
struct IslandLevel {
  std::uint64_t island = 0;
  std::int32_t level = 0;  ///< a voxel's edge is 2^level blocks
  bool far = false;        ///< see SectionKey
  auto operator<=>(const IslandLevel&) const = default;
};

/// Names a resident chunk mesh.
struct SectionKey {
  std::uint64_t island = 0;
  IVec3 chunk;             ///< chunk coordinate at its level
  std::int32_t level = 0;  ///< a voxel's edge is 2^level blocks
  /// The only section of its island, made from samples of the island's design (far_island.h); its
  /// chunk is {0, 0, 0} and has the lattice's origin in its middle.
  bool far = false;
  IslandLevel row() const { return {island, level, far}; }
  auto operator<=>(const SectionKey&) const = default;
};

struct ReadySection {
  SectionKey key;
  ChunkMesh mesh;                 ///< without a quad if there is nothing to be seen of the chunk
  ChunkOccupancy leaves;          ///< cut-out voxels; empty unless asked for occupancy
  ChunkOccupancy occupancy;       ///< empty unless asked for, and of far sections; of the two,
                                  ///< one at least is not empty
  std::vector<Emitter> emitters;  ///< of the mesh
  SeamFaces seams;                ///< none of far sections
  std::vector<StainedVoxel> stained{};  ///< stained glass; none unless asked for occupancy
};

/// What to change: first remove, then add. A key that is replaced stands in both lists.
struct StreamUpdate {
  std::vector<SectionKey> removed;
  std::vector<ReadySection> ready;
};

struct StreamView {
  WorldPos camera;
  glm::dvec3 forward{0.0, 0.0, 1.0};  ///< unit length
  double time_s = 0.0;                ///< decides where drifting islands are
};

struct StreamSettings {
  double view_distance_blocks = 1000.0;
  double detail_distance_blocks = 192.0;  ///< where level 1 begins, see level_from
  /// Islands that reach across levels have those that their far ends want, too, so that each of
  /// their sections can be drawn at a level of its own (section_tree.h).
  bool far_ends = false;
};

/// Levels of detail past the last one of VoxelSource: islands as one section each.
inline constexpr int kFarLevelCount = 3;

/// An island's level of detail by the distance [blocks] from the camera to its bounding sphere
/// (negative inside): the last one whose level_from() is not beyond it, up to
/// kLevelCount + kFarLevelCount - 1.
int island_level(const IslandSpec& spec, double distance_blocks, double detail_distance_blocks);

/// The distance [blocks] from which on an island has a level or a coarser one: the detail distance
/// for level 1, twice as much for each further one. Small islands keep each level up to twice as
/// far: more of what is seen of them is outline, and they have few faces. Far sections begin where
/// those of all islands do; their voxels follow an island's size (far_voxel_log2).
/// @param level 1 or more.
double level_from(const IslandSpec& spec, int level, double detail_distance_blocks);

/// What a streamer makes of chunks.
enum class StreamOf : std::uint8_t { kMeshes, kMeshesAndOccupancy };

/// Keeps the islands around a camera meshed. An island is in while its bounding sphere comes within
/// view distance, as a whole at one level of detail, so that it has no cracks. From level
/// kLevelCount on it is one far section, unless it is not as its seed makes it: such islands have
/// no level past the last one of VoxelSource. With StreamSettings::far_ends it also has the levels
/// of its far ends, each as a whole and in one update.
///
/// The frame thread calls everything here; generation and meshing run on jobs: islands that are new
/// to the view as far sections at first, then what is near and in view. No call but
/// wait_until_complete waits for them. Chunks near the camera that were edited are the exception:
/// update() makes the first few itself, so that they are shown by the frame of the edit. An island
/// that changes its level keeps the old one until all of the new one can replace it in one update.
/// While the camera moves, islands near a limit keep their state (5% of the distance). A streamer
/// that has not yet seen another view has no state to keep: what it delivers depends on the view
/// and the settings alone.
class Streamer {
 public:
  /// Both must outlive the streamer.
  Streamer(World& world, Jobs& jobs, StreamOf made = StreamOf::kMeshes);
  /// Cancels what is queued and waits for what is running.
  ~Streamer();
  Streamer(const Streamer&) = delete;
  Streamer& operator=(const Streamer&) = delete;

  /// Decides what should be resident and queues the work. Call once a frame.
  void update(const StreamView& view, const StreamSettings& settings);
  /// Hands out changes, nearest island first, until `max_quads` quads are reached. The last section
  /// may pass the limit, and an island that swaps levels is never cut.
  StreamUpdate poll(std::size_t max_quads);
  /// Whether all that the last update asked for has been made and handed out.
  bool complete() const;
  /// Whether all of an island's chunks at the level it is shown at have been handed out.
  bool settled(std::uint64_t island) const;
  /// Blocks until all that the last update asked for has been made; poll then hands it out, in an
  /// order that does not depend on threads.
  void wait_until_complete();

  /// Islands that are within view distance and not kept, because kMaxStreamedIslands are nearer.
  struct LeftOut {
    std::size_t islands = 0;
    double from_blocks = 0.0;  ///< from the camera to the nearest of them; 0: there is none
  };
  /// As of the last update that asked the world.
  const LeftOut& left_out() const;

  struct Stats {
    std::size_t islands = 0;      ///< resident or coming
    std::size_t unshown = 0;      ///< of them, those of which nothing has been handed out yet
    std::size_t sections = 0;     ///< handed out and not removed
    std::size_t tasks_left = 0;   ///< queued or running
    std::size_t chunks_made = 0;  ///< generated and meshed so far, empty ones included
    std::size_t times_asked = 0;  ///< times that update() has waited for the archipelago's plan
  };
  Stats stats() const;

 private:
  struct State;
  std::shared_ptr<State> state_;  // jobs hold it too: one may start after the streamer has gone
};

}  // namespace skerry::world
