#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "engine/core/worker_threads.h"
#include "world/light/lamp_reaches.h"
#include "world/light/light_cache.h"
#include "world/light/sky_transfer.h"
#include "world/stream/stream.h"

namespace skerry::game {

/// The light of the sky on the islands that are resident, what their faces reflect to each other,
/// and where their lamps can arrive, found on threads in the background. An island is looked at as
/// a whole at first; of the nearest ones enough is kept that an edit has only that looked at again
/// which it changes. What is found depends on the voxels alone, and on the directions from which
/// light of sun and moon is followed as it is. The frame thread calls everything here.
class IslandLight {
 public:
  enum class Finds : std::uint8_t {
    kReach,    ///< the reach of lamps alone
    kSky,      ///< and the sky's light and that of weak lamps
    kBounces,  ///< and what faces reflect to each other
  };
  /// @param cache light that others have found, and that this finds; null: none. It outlives the
  /// threads' jobs. With one, each look is at a whole island, and nothing is kept for edits.
  IslandLight(WorkerThreads& threads, Finds finds, world::LightCache* cache = nullptr);
  Finds finds() const { return finds_; }

  /// Takes in a chunk. Each level of an island is looked at as if it were an island of its own. A
  /// chunk that takes the place of another has a guess (world::inherit_faces) until its level has
  /// been looked at again.
  void add(const world::SectionKey& key, world::LightChunk chunk);
  /// Removes it. A chunk that was not added is ignored.
  void remove(const world::SectionKey& key);
  /// What closes a chunk where another level is drawn beside it, in place of what did. These faces
  /// get the light of faces next to them, which a thread looks up: poll() says so some calls later.
  void close(const world::SectionKey& key, std::vector<shared::Quad> seams);
  /// Removes a level of an island and its light.
  void end_island(const world::IslandLevel& row);
  struct Key {
    std::size_t slot = 0;
    glm::vec3 direction{};
  };
  struct Near {
    double distance = 0.0;   ///< of an island from the camera
    bool keyed = false;      ///< what has been followed from key directions is wanted
    std::optional<Key> key;  ///< light is to be followed from there, if it has not been
  };
  using NearIslands = std::map<world::IslandLevel, Near>;
  /// Looks at islands that have changed and whose chunks have all come: what is not there yet would
  /// let light into rooms that it closes. The nearest one first.
  /// @param islands called when they are needed. @param now calls it in any case, and looks at a
  /// whole island for a key's sake; else that waits until there is nothing else to do.
  void start(const world::Streamer& streamer, const std::function<NearIslands()>& islands,
             bool now);
  /// Waits until all that was started has been found.
  void wait() { threads_.wait(); }

  /// Whether poll() has said all that follows from the chunks as they are.
  bool settled() const;
  /// Whether threads look, or have, and poll() has not said what they found.
  bool searching() const;
  /// Whether poll() has more to say of what has been found.
  bool guesses() const;
  /// Seconds that threads have computed so far.
  double work_seconds() const { return work_->load(); }

  struct FoundChunk {
    world::IVec3 at;
    std::shared_ptr<const world::ChunkSky> sky;
    bool changed = true;  ///< against what poll() last said
  };
  struct Found {
    world::IslandLevel row;
    std::vector<FoundChunk> chunks;  ///< ascending
    world::KeyDirections keys{};     ///< from which light has been followed
  };
  /// What has been found of the sky since the last call. An island that has changed meanwhile is
  /// looked at again. What has waited for a thread for some calls is done at once, a chunk a call.
  std::vector<Found> poll();

  struct FoundReach {
    world::SectionKey section;
    std::vector<world::LampReach::Bricks> reach;  ///< of LightChunk::strong, in its order
  };
  /// Where lamps can arrive, found since the last call, sooner than poll(); of islands that have
  /// not changed meanwhile.
  std::vector<FoundReach> poll_reach();

 private:
  using Skies = world::SkyTransfer::Skies;
  using Seams = std::map<world::IVec3, std::shared_ptr<const std::vector<shared::Quad>>>;
  struct Search;
  /// Light of a chunk whose seams are closed, and what it was made of.
  struct Closed {
    std::shared_ptr<const world::ChunkSky> found, sky;
    std::shared_ptr<const std::vector<shared::Quad>> seams;
  };
  /// Light of a chunk that has changed since it was looked at: faces that are not in `base` get the
  /// light of faces next to them. Made by the frame thread, read when `done`.
  struct Guess {
    std::shared_ptr<const world::LightChunk> chunk;  // null: its faces are those of `base`
    std::shared_ptr<const world::ChunkSky> base;
    std::shared_ptr<const std::vector<shared::Quad>> seams;  // null: none
    std::shared_ptr<const world::ChunkSky> sky;
    int calls = 0;                    // of poll(), since it was asked for
    std::atomic<bool> taken = false;  // by the thread that makes it
    std::atomic<bool> done = false;
    world::ChunkSky made() const;
    bool take() { return !taken.exchange(true); }
  };
  /// Where the lamps of chunks can arrive.
  struct Reaches {
    world::LightChunks of;
    world::LampReaches found;
  };
  struct Island {
    world::LightChunks chunks;
    Seams seams;
    std::uint64_t version = 0;  // grows with every change
    std::uint64_t asked = 0;    // version that was looked at last
    std::shared_ptr<Search> search;
    std::unique_ptr<world::SkyTransfer> kept;                // of the version that was asked last
    std::shared_ptr<const Reaches> reaches;                  // alike
    world::KeyDirections keys, said_keys;                    // alike; of `known`
    Skies known;                                             // as poll() last said, or says next
    std::map<world::IVec3, Closed> closings;                 // as the last look made them
    std::set<world::IVec3> guessed;                          // of `known`, since poll() last said
    std::map<world::IVec3, std::shared_ptr<Guess>> guesses;  // on their way to `known`
    void guess(world::IVec3 at);  // what is known of a chunk, for the faces that it has now
  };
  void ask_guess(Island& island, world::IVec3 at, std::shared_ptr<Guess> guess);
  static void take_guesses(Island& island, int& most);
  static Found guessed_of(const world::IslandLevel& row, Island& island);
  Found found_of(const world::IslandLevel& row, Island& island, Search& search);
  static void run(WorkerThreads& threads, std::shared_ptr<Search> search);
  static void run_or_take(WorkerThreads& threads, std::shared_ptr<Search> search);
  static void look_at_sky(WorkerThreads& threads, std::shared_ptr<Search> search);
  static void follow_bounces(WorkerThreads& threads, std::shared_ptr<Search> search, int step);
  static void follow_key(WorkerThreads& threads, std::shared_ptr<Search> search, int step);
  static void end_look(Search& search, Skies skies);
  struct Rank;
  std::vector<Rank> by_distance(const NearIslands& islands);
  void begin(const Rank& rank, bool now);
  /// Has a thread free what takes milliseconds to free.
  template <class T>
  void discard(T unused);

  WorkerThreads& threads_;
  const Finds finds_;
  world::LightCache* const cache_;
  std::shared_ptr<std::atomic<double>> work_ = std::make_shared<std::atomic<double>>(0.0);
  int calls_with_nothing_new_ = 0;
  std::map<world::IslandLevel, Island> islands_;
};

}  // namespace skerry::game
