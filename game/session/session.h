// The messages between clients and a session, and the session itself.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "engine/core/interruption.h"
#include "engine/core/result.h"
#include "game/session/journal.h"
#include "game/session/saved_play.h"
#include "world/islands/world.h"
#include "world/store/chunk_blob.h"
#include "world/voxel/edits.h"
#include "world/voxel/motion_state.h"

namespace skerry::game {

// From client to session. ------------------------------------------------------------------------

/// The first request of a client. Until it is accepted, no other request has an effect and no
/// answer but notices is sent. Refused with a notice: a name over kMaxPlayerBytes, one that is
/// taken by another client, more than kMaxPlayers names in one world.
struct Join {
  std::string player;  ///< UTF-8; empty: the one player of a world that is played alone
  /// It reads Session::world(): voxels that change are not sent unless it asks for them.
  bool shares_world = false;
};
/// Asks what was changed in a chunk of level 0: a client generates the rest itself.
struct ChunkWanted {
  std::uint64_t island = 0;
  world::IVec3 chunk;
};
/// Puts a block, or with air takes one away.
struct Edit {
  std::uint64_t island = 0;
  world::IVec3 voxel;
  world::BlockId block = world::kAir;
};
/// Where the player is and looks; decides what is within reach.
struct PlayerMoved {
  SavedPlay play;
};
/// Sets the engines of the island that the player stands on, until the next Steer. Zeros switch
/// them off, wherever the player is.
struct Steer {
  std::uint64_t island = 0;
  glm::dvec3 thrust{};  ///< in the island's axes; length at most 1 counts
  double turn = 0.0;    ///< -1 .. 1, about +y
};
/// Replaces the player's journal. One that no file may hold (fits_file) has no effect.
struct KeepJournal {
  Journal journal;
};
using Request = std::variant<Join, ChunkWanted, Edit, PlayerMoved, Steer, KeepJournal>;

// From session to client. ------------------------------------------------------------------------

/// Accepts a Join. Sent right after it: the time, every island that differs from what the seed
/// makes, the poses of all that move.
struct Joined {
  world::WorldInfo world;
  std::optional<SavedPlay> play;          ///< none: begin at the spawn
  Journal journal;                        ///< the player's, as it was kept last
  bool read_only = false;                 ///< nothing of this play will be saved
  std::vector<world::ChunkName> changed;  ///< what ChunkWanted may be asked for
};
/// Changed voxels of a chunk: the answer to ChunkWanted, edits of other clients, and voxels that
/// broke off. Voxels of an island that no seed made are air until a message sets them.
struct ChunkChanges {
  std::uint64_t island = 0;
  world::IVec3 chunk;
  world::ChunkEdits edits;
};
enum class EditVerdict : std::uint8_t {
  kDone,
  kNoSuchIsland,
  kNoSuchBlock,
  kTooFar,    ///< beyond kSessionReach
  kTooFast,   ///< more than kEditsPerSecond for long
  kOccupied,  ///< a block is put where one is
  kEmpty,     ///< a block is taken where none is
  kUnknown,   ///< the voxel is not loaded yet
};
/// Sent to the client that asked. When done, the voxel is as the edit says; the other clients get
/// ChunkChanges.
struct EditAnswer {
  Edit edit;
  EditVerdict verdict = EditVerdict::kDone;
  world::BlockId was = world::kAir;  ///< what stood there
};
/// An island that is not as the seed makes it. Sent before anything else of it that a client does
/// not have.
struct IslandIs {
  world::IslandSpec spec;
  bool added = false;            ///< no seed made it
  std::uint64_t broken_off = 0;  ///< the island that it came off just now; 0: it was there before
  std::uint64_t blocks = 0;      ///< that came off
};
/// Poses that islands off their course took, in the order of their ticks: between two that follow
/// one another an island moves straight, else it stood still (World::move_island).
struct IslandsMoved {
  std::vector<world::MovingIsland> moves;
};
struct TimeIs {
  double world_time_s = 0.0;
};
/// One line for the player: a full disk, a damaged chunk.
struct Notice {
  std::string text;
};
using Answer =
    std::variant<Joined, ChunkChanges, EditAnswer, IslandIs, IslandsMoved, TimeIs, Notice>;

/// Messages one way, from any thread to any other.
template <class Message>
class Mailbox {
 public:
  void put(Message message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
  }
  std::vector<Message> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
  }

 private:
  std::mutex mutex_;
  std::vector<Message> messages_;
};

// ------------------------------------------------------------------------------------------------

/// How far from the eye edits may be, to the nearest point of the voxel [blocks]. A little more
/// than hands reach: the island moves while a message is on its way.
inline constexpr double kSessionReach = 8.0;
/// Edits a second in the long run, and how many may come at once.
inline constexpr double kEditsPerSecond = 32.0, kEditBurst = 64.0;

/// Names a client of a session; never used twice.
using ClientId = std::uint32_t;

/// A world that is played: owns it and its file, keeps its time, checks the edits of its clients
/// and forwards them, moves islands off their course, saves.
class Session {
 public:
  /// A saved world, where it was left. A file that may not be written is played, too. While the
  /// session lives, a signal to end the process saves first (engine/core/interruption.h). Errors:
  /// those of WorldFile::open; the file is open in another process.
  static Result<std::unique_ptr<Session>> open(const std::filesystem::path& path);
  /// A world that is saved nowhere, from `time_s` on.
  static std::unique_ptr<Session> play(std::shared_ptr<world::World> world, double time_s);
  /// Saves what is not saved yet and waits for that.
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// For clients in this process, so that nothing is generated or kept twice. Read-only: it changes
  /// as the messages say.
  std::shared_ptr<world::World> world() const;

  // Clients and their messages, from any thread. ------------------------------------------------
  ClientId connect();
  /// The client's place is kept; its answers are dropped. For sessions of several clients, as tests
  /// have them: the game's one client stays as long as its session.
  void disconnect(ClientId client);
  /// Requests of all clients are handled in the order of these calls, by the calls below. Those of
  /// a client that is not connected have no effect.
  void send(ClientId client, Request request);
  std::vector<Answer> receive(ClientId client);

  // By who runs the session, always on one thread. None waits for the disk but save(). -----------
  /// Handles the requests that were sent.
  void attend();
  /// The same; then time goes on, the islands move, and every few seconds the world is saved.
  void advance(double seconds);
  /// As advance(), while the world's time stands still.
  void rest() { advance(0.0); }
  /// The next advance() or rest() saves, however short ago that was done.
  void save_next();
  /// Blocks until all is saved. Errors: those of the file; the play may go on.
  Result<void> save();

 private:
  struct Client;
  struct State;
  explicit Session(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
  std::unique_ptr<DoneWhenInterrupted> saved_when_interrupted_;
};

}  // namespace skerry::game
