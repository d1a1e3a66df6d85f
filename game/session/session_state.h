// What Session keeps. Private to game/session*.cpp.
#pragma once
#include <array>
#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <set>

#include "game/session/session.h"
#include "game/session/task_thread.h"
#include "world/motion.h"
#include "world/split.h"
#include "world/store/chunk_blob.h"
#include "world/store/world_file.h"

namespace skerry::game {

/// What has changed since it was last written.
struct Unsaved {
  std::set<world::ChunkName> chunks;
  std::set<std::uint64_t> islands;  ///< that have come into being

  void merge(const Unsaved& other) {
    chunks.insert(other.chunks.begin(), other.chunks.end());
    islands.insert(other.islands.begin(), other.islands.end());
  }
};

/// A fragment that has become an island, on its way to the frame thread.
struct BrokenPiece {
  std::uint64_t island = 0, broken_off = 0;
  world::Mass mass;                  ///< in the old lattice
  glm::dvec3 shift{};                ///< from the old lattice to the new
  std::vector<world::IVec3> voxels;  ///< in the old lattice; none: too many to name
  std::unique_ptr<world::Shape> shape;
};

struct Session::State {
  explicit State(std::shared_ptr<world::World> opened);
  ~State();

  // session.cpp: messages.
  void handle_sent();
  void handle(const Request& request);
  void join(const Join& join);
  void introduce(std::uint64_t island);
  void tell_moves();
  void tell_chunk(const world::ChunkName& name);
  world::ChunkEdits changes_of(const world::ChunkName& name);
  void edit(const Edit& edit);
  EditVerdict verdict(const Edit& edit, world::BlockId& was);
  void tell(std::string text) { answers.put(Notice{std::move(text)}); }

  // session_split.cpp: on the worker, and what comes back.
  void follow_edit(const Edit& edit, world::BlockId was);
  void look_for_fragments(const Edit& edit, bool solid, double at_s);
  void take_in_pieces();
  std::optional<world::BrokenOff> break_off(std::uint64_t island, const world::Fragment& fragment,
                                            double at_s);
  void tell_break(std::uint64_t island, const world::LoosePiece& loose,
                  const world::BrokenOff& off);
  std::unique_ptr<world::Shape> shape_for(std::uint64_t island);

  // session_save.cpp.
  void load(world::LoadedWorld& loaded);
  void save_soon();
  Result<void> write(const std::vector<world::MovingIsland>& moving,
                     const std::optional<SavedPlay>& play_now);

  const std::shared_ptr<world::World> world;
  std::unique_ptr<world::WorldFile> file;  // none: this world is saved nowhere
  bool read_only = false;
  std::optional<SavedPlay> saved;  // as the file had it
  Mailbox<Request> requests;
  Mailbox<Answer> answers;

  // Frame thread.
  world::IslandMotion motion;
  std::vector<world::MovingIsland> moves;  // since they were told
  std::optional<SavedPlay> play;           // as the client said last
  double edits_left = kEditBurst;
  double time_s = 0.0;
  struct ShapeOnItsWay {
    std::map<world::IVec3, bool> edits;  // since it was asked for: what is solid now, what is not
    bool outdated = false;               // by more than is worth naming
    std::shared_ptr<Mailbox<std::unique_ptr<world::Shape>>> box;
  };
  std::map<std::uint64_t, ShapeOnItsWay> shapes;
  std::chrono::steady_clock::time_point saved_at;
  Mailbox<BrokenPiece> pieces;
  std::vector<BrokenPiece> waiting_pieces;  // for the shape of what they broke off

  // All threads. What is told of voxels is put into `answers` with `breaking` held, so that it
  // comes in the order in which it was done.
  std::mutex breaking;  // held while voxels go from one island to another, for a moment
  // The frame thread writes these two with `breaking` held, and reads them without.
  bool joined = false;
  bool voxels_told = false;
  std::set<std::uint64_t> introduced;  // with `breaking` held: islands that an IslandIs has named
  std::atomic<std::uint64_t> edits_made = 0;  // grows with `breaking` held
  std::atomic<bool> leaving = false;          // nobody waits for shapes any more
  std::mutex saving;                          // held while a state of the world is taken down
  std::mutex unsaved_mutex;
  Unsaved unsaved;
  std::atomic<bool> save_under_way = false;
  std::mutex problem_mutex;
  std::string problem;  // of the last save, if it failed

  // Worker only.
  struct KnownGrid {
    std::uint64_t island = 0;
    std::unique_ptr<world::SolidGrid> grid;
  };
  std::array<KnownGrid, 4> grids;  // of the islands edited last, newest first

  // Last, so that they end first.
  TaskThread worker, shaper, saver;
};

}  // namespace skerry::game
