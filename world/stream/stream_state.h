// What Streamer keeps. Private to world/stream*.cpp.
#pragma once
#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "world/stream/stream.h"

namespace skerry::world {

/// One chunk of an island at one level.
struct StreamSlot {
  enum class Phase : std::uint8_t {
    kIdle,     // not asked for: its level is about to be replaced
    kQueued,   // a task waits for a worker
    kRunning,  // a worker makes it
    kMade,     // what was made of it waits to be handed out
    kDone,     // handed out, or made and empty
  };
  Phase phase = Phase::kQueued;
  bool stale = false;     // edited while a worker makes it: make it again
  bool resident = false;  // handed out and not removed
  ChunkMesh mesh;
  std::vector<Emitter> emitters;
  ChunkOccupancy leaves, occupancy;
  SeamFaces seams;
  std::vector<StainedVoxel> stained;
  bool has_something() const {
    return !mesh.quads.empty() || occupancy.fill != ChunkOccupancy::Fill::kEmpty;
  }
};

/// An island at one level.
struct StreamLevel {
  int level = 0;             // of detail
  int voxel_log2 = 0;        // see SectionKey::level
  std::uint64_t serial = 0;  // distinguishes results of cancelled work from those wanted
  bool planned = false;      // `slots` holds every chunk
  std::size_t unmade = 0;    // slots queued or running
  std::size_t made = 0;      // slots in phase kMade
  std::map<IVec3, StreamSlot> slots;
  std::vector<IVec3> edited_early;  // chunks edited before the plan was there
  bool far() const { return level >= kLevelCount; }
  SectionKey key(std::uint64_t island, IVec3 chunk) const {
    return {island, chunk, voxel_log2, far()};
  }
  bool all_made() const { return planned && unmade == 0; }
  bool any_resident() const {
    return std::any_of(slots.begin(), slots.end(),
                       [](const auto& entry) { return entry.second.resident; });
  }
};

struct StreamIsland {
  IslandSpec spec;
  double distance = 0.0;              // blocks from the camera to the bounding sphere
  glm::dvec3 camera{}, forward{};     // in lattice axes, blocks
  StreamLevel shown;                  // what is, or becomes, visible chunk by chunk
  std::optional<StreamLevel> coming;  // replaces `shown` when all of it is made
  int far_end = 0;                    // the level that its far end wants
  std::map<int, StreamLevel> beyond;  // by level, past that of `target` up to `far_end`
  const StreamLevel& target() const { return coming ? *coming : shown; }
  bool wants_beyond(int level) const { return level > target().level && level <= far_end; }
  /// Whether something is still to be made or handed out.
  bool busy() const {
    const auto left = [](const StreamLevel& level) { return !level.all_made() || level.made != 0; };
    return coming || left(shown) ||
           std::any_of(beyond.begin(), beyond.end(),
                       [&](const auto& entry) { return left(entry.second); });
  }
  bool swappable() const { return coming && coming->all_made(); }
};

struct StreamTask {
  std::uint64_t island = 0, serial = 0;
  std::optional<IVec3> chunk;  // none: list the island's chunks
  int level = 0;               // see SectionKey
  bool far = false;            // likewise
  bool edited = false;         // a chunk of level 0 that a player has changed: before all others
  bool beyond = false;         // of a level of a far end: after all others
  double cost = 0.0;           // least first: distance, longer for what is out of view
};

/// Working memory of one job.
struct StreamScratch {
  std::vector<BlockId> voxels = std::vector<BlockId>(kPaddedVoxels);
  MeshScratch mesh;
};

/// What a job brings back.
struct MadeChunk {
  ChunkMesh mesh;
  std::vector<Emitter> emitters;
  ChunkOccupancy leaves, occupancy;
  SeamFaces seams;
  std::vector<StainedVoxel> stained;
  std::optional<Chunk> voxels;  // of level 0
};

struct Streamer::State : std::enable_shared_from_this<Streamer::State> {
  State(World& world_, Jobs& jobs_, StreamOf makes_) : world(world_), jobs(jobs_), makes(makes_) {}

  /// An island that may be in view.
  struct Near {
    const IslandSpec* spec;
    Pose pose;
    double distance;  // blocks from the camera to the bounding sphere
  };
  /// What the world is asked for: islands that come within `reach + slack` of a place, so that the
  /// answer holds until the camera has moved by `slack`.
  struct Look {
    WorldPos centre;
    double time_s = 0.0;
    double reach = -1.0, slack = 0.0;  // blocks
    std::uint64_t revision = 0;        // of the world
    bool holds_for(const Look& now) const;
    /// The same with the camera halfway out: time for the next answer.
    bool wears_out(const Look& now) const;
  };
  /// Frame thread only, without the mutex.
  bool look_around(const StreamView& view, const StreamSettings& settings,
                   const IslandPoses& poses);
  bool take_answer(const Look& now, std::vector<IslandSpec>& specs);
  std::vector<IslandSpec> ask(const Look& look) const;
  void replace_candidates(std::span<const IslandSpec> specs, bool same_world);
  static Near near_of(const IslandSpec& spec, const StreamView& view, const IslandPoses& poses);

  // What is wanted (stream.cpp). Called with the mutex held.
  struct Candidate;
  void place_islands(const StreamView& view, const StreamSettings& settings,
                     const IslandPoses& poses, std::vector<std::uint64_t>& voxels_unused,
                     std::vector<std::uint64_t>& gone);
  void drop_island(StreamIsland& island, std::vector<std::uint64_t>& gone);
  void drop_left(std::vector<std::uint64_t>& gone);
  void place_island(Candidate& candidate, const Near& near, const StreamView& view,
                    const StreamSettings& settings, std::vector<std::uint64_t>& voxels_unused);
  int level_of(const IslandSpec& spec, int level) const;
  void change_level(StreamIsland& island, int level);
  void change_far_end(StreamIsland& island, const StreamSettings& settings);
  void apply_edit(const EditedBox& edit);

  // Tasks and their results (stream_state.cpp). Called with the mutex held.
  StreamLevel start_level(const IslandSpec& spec, int level, bool beyond = false);
  StreamLevel* find_level(std::uint64_t island, std::uint64_t serial);
  void push_task(const StreamTask& task);
  void queue_chunk(std::uint64_t island, const StreamLevel& level, IVec3 chunk, bool edited);
  void remake(std::uint64_t island, StreamLevel& level, IVec3 chunk, bool edited);
  void score_tasks();
  double cost_of(const StreamTask& task) const;
  bool plan_unused(std::uint64_t id) const;
  bool take_task(StreamTask& task);
  bool all_made() const { return tasks.empty() && !look_ahead && running == 0; }
  void note_planned(const StreamTask& task, const std::vector<IVec3>& chunks);
  void note_made(const StreamTask& task, MadeChunk&& chunk);

  /// Starts one job for each task pushed since the last call. Without the mutex.
  void submit_jobs();
  void run_task();
  /// Makes the first few edited chunks on this thread, so that the frame shows them. Without the
  /// mutex.
  void make_edited();
  void run(const StreamTask& task, std::unique_lock<std::mutex>& lock);
  void run_look(std::unique_lock<std::mutex>& lock);

  World& world;
  Jobs& jobs;
  const StreamOf makes;
  /// An island that may come into view, and when it must be looked at again.
  struct Candidate {
    IslandSpec spec;
    StreamIsland* island = nullptr;  // of `islands`; null: it is not in
    double due = 0.0;                // of Around::travelled: until then nothing changes for it
  };
  struct Around {
    Look look;
    bool asked_ahead = false;  // a worker has been asked for the next answer
    std::size_t asked = 0;     // times that update() has asked the world itself
    std::vector<Candidate> islands;
    std::vector<StreamIsland*> left;  // in, but not among `islands` any more
    LeftOut left_out;
    double fastest = 0.0;    // an island on its course, blocks/s at most
    double travelled = 0.0;  // blocks by which camera and any island have come nearer, at most
    StreamView view;         // of the last update
    StreamSettings settings;
  };
  Around around;             // frame thread only
  mutable std::mutex mutex;  // guards everything below; held for bookkeeping only
  std::condition_variable idle;
  bool stopping = false;
  int running = 0, running_edited = 0;
  std::size_t to_submit = 0;
  std::uint64_t last_serial = 0;
  std::size_t chunks_made = 0;
  std::vector<StreamTask> tasks;   // heap, cheapest on top
  std::optional<Look> look_ahead;  // before all tasks
  /// The answer to the last one.
  struct Answer {
    Look look;
    std::vector<IslandSpec> specs;
  };
  std::optional<Answer> answer;
  std::map<std::uint64_t, StreamIsland> islands;
  std::vector<SectionKey> removed;  // of islands that left
  std::vector<std::unique_ptr<StreamScratch>> spare;
};

}  // namespace skerry::world
