// What Session keeps.
#pragma once
#include <array>
#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <set>

#include "engine/core/worker_threads.h"
#include "game/session/session.h"
#include "world/motion/motion.h"
#include "world/motion/split.h"
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

/// A fragment that has become an island, on its way to the session thread.
struct BrokenPiece {
  std::uint64_t island = 0, broken_off = 0;
  world::Mass mass;                  ///< in the old lattice
  glm::dvec3 shift{};                ///< from the old lattice to the new
  std::vector<world::IVec3> voxels;  ///< in the old lattice; none: too many to name
  std::unique_ptr<world::Shape> shape;
};

struct Session::Client {
  Mailbox<Answer> answers;

  // Session thread.
  std::string player;
  std::optional<SavedPlay> play;  // as the client said last, else as it was saved
  double edits_left = kEditBurst;

  // The session thread writes these with `breaking` held, and reads the first without.
  bool joined = false;
  bool gets_voxels = false;
  std::set<std::uint64_t> introduced;  // islands that an IslandIs has named
};

struct Session::State {
  explicit State(std::shared_ptr<world::World> opened);
  ~State();

  // session.cpp: messages.
  std::shared_ptr<Client> find(ClientId client) const;
  std::vector<std::shared_ptr<Client>> everyone() const;
  std::vector<std::shared_ptr<Client>> joined() const;
  void handle_sent();
  void handle(Client& client, const Request& request);
  std::string refusal_of(const Join& join) const;
  void join(Client& client, const Join& join);
  void introduce(Client& client, std::uint64_t island);
  void moved(Client& client, const SavedPlay& play);
  void steer(const Client& client, const Steer& steer);
  void keep(const Client& client, const Journal& journal);
  void tell_moves();
  void tell_chunk(Client& client, const world::ChunkName& name);
  world::ChunkEdits changes_of(const world::ChunkName& name);
  void edit(Client& client, const Edit& edit);
  void forward(const Client& from, const Edit& edit);
  EditVerdict verdict(const Client& client, const Edit& edit, world::BlockId& was);
  void tell_all(const std::string& text);

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
  /// What of a state the session thread alone knows.
  struct Snapshot {
    std::vector<world::MovingIsland> moving;
    std::map<std::string, SavedPlay> plays;
    std::shared_ptr<const Journals> journals;
  };
  Snapshot snapshot() const { return {motion.states(), plays, journals}; }
  Result<void> write(const Snapshot& now);

  const std::shared_ptr<world::World> world;
  std::unique_ptr<world::WorldFile> file;  // none: this world is saved nowhere
  bool read_only = false;
  Mailbox<std::pair<ClientId, Request>> requests;
  mutable std::mutex
      clients_mutex;  // held for the map alone, never while another one is waited for
  std::map<ClientId, std::shared_ptr<Client>> clients;
  ClientId last_client = 0;
  std::vector<std::string> notices;  // of opening the file: for every client

  // Session thread, with `running` held: a signal to end saves from a thread of its own.
  std::mutex running;
  world::IslandMotion motion;
  std::vector<world::MovingIsland> moves;  // since they were sent
  std::map<std::string, SavedPlay> plays;  // by player: as said last, else as it was saved
  std::shared_ptr<const Journals> journals = std::make_shared<Journals>();  // replaced, not changed
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

  // All threads. Answers about voxels are sent with `breaking` held, so that each client gets them
  // in the order in which the voxels changed.
  std::mutex breaking;  // held while voxels go from one island to another, for a moment
  std::atomic<std::uint64_t> edits_made = 0;  // grows with `breaking` held
  std::atomic<bool> leaving = false;          // no one waits for shapes any more
  std::mutex saving;                          // held while a state of the world is taken down
  std::mutex unsaved_mutex;
  Unsaved unsaved;
  std::atomic<bool> save_under_way = false;
  std::shared_ptr<const Journals> journals_written;  // by who writes, one at a time
  std::mutex problem_mutex;
  std::string problem;  // of the last save, if it failed

  // Worker only.
  struct KnownGrid {
    std::uint64_t island = 0;
    std::unique_ptr<world::SolidGrid> grid;
  };
  std::array<KnownGrid, 4> grids;  // of the islands edited last, newest first

  // Last, so that they end first.
  WorkerThreads worker{1}, shaper{1}, saver{1};
};

}  // namespace skerry::game
