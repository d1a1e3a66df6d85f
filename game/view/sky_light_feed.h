#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "engine/render/light/indirect_store.h"
#include "game/view/island_light.h"

namespace skerry::gpu {
class Uploader;
}

namespace skerry::game {

/// Hands the light of the sky on islands to the renderer's store: nearest islands first, a frame's
/// share at a time. Where the store has no room, the farthest islands are without, until there is
/// room or they come nearer. The frame thread calls everything here.
class SkyLightFeed {
 public:
  /// Takes in what is known of an island now.
  void add(IslandLight::Found found);
  /// Forgets a level of an island. Its light in the store is the caller's to end.
  void remove(const world::IslandLevel& row) { entries_.erase(row); }
  void clear() { entries_.clear(); }
  /// Whether hand_over() can have anything to do.
  bool idle() const;

  struct NearIsland {
    std::uint32_t slot = 0;  ///< of the island table
    double distance = 0.0;   ///< of the camera from its bounding sphere [blocks]; 0 inside
  };
  /// Puts chunks until `most_bytes` wait in the uploader. @param islands by id: an entry without
  /// one waits. @return whether there is more to put, now or once the GPU is done with what has
  /// been freed.
  bool hand_over(render::IndirectStore& store, gpu::Uploader& uploader,
                 const std::map<world::IslandLevel, NearIsland>& islands, std::uint64_t most_bytes);
  /// Islands all of whose light the renderer has got since the last call, and the directions from
  /// which that has been followed.
  using Shown = std::vector<std::pair<world::IslandLevel, world::KeyDirections>>;
  Shown shown() { return std::exchange(shown_, {}); }
  /// Whether anything is known of a level of an island, and whether all of it has been handed over.
  bool has(const world::IslandLevel& row) const { return entries_.contains(row); }
  bool shows(const world::IslandLevel& row) const {
    const auto found = entries_.find(row);
    return found != entries_.end() && found->second.state == State::kShown;
  }
  /// Takes all light out of the store; hand_over() puts it again, the nearest islands first.
  void take_back(render::IndirectStore& store, gpu::Uploader& uploader);
  /// Why islands were left without light since the last call, once.
  std::optional<std::string> refusal() { return std::exchange(refusal_, std::nullopt); }

 private:
  enum class State : std::uint8_t { kWaiting, kShown, kDark };
  struct Entry {
    IslandLight::Found found;
    render::IslandChunks box;
    std::uint64_t bytes = 0;  // that all of it takes
    State state = State::kWaiting;
    bool in_store = false;  // has memory there
    bool begun = false;
    std::size_t next = 0;            // chunk to put
    std::set<world::IVec3> unshown;  // chunks that changed since finish()
    std::uint64_t dark_until = 0;    // room for it at which to try again [bytes]
    double distance = 0.0;           // as last told
    std::uint32_t slot = 0;
  };
  enum class Put : std::uint8_t { kDone, kPaused, kFull };
  Put put(render::IndirectStore& store, gpu::Uploader& uploader, Entry& entry,
          std::uint64_t most_bytes);
  std::vector<Entry*> nearest(State state, const std::map<world::IslandLevel, NearIsland>& islands);
  std::vector<Entry*> lit_beyond(double distance);
  std::uint64_t room_for(const render::IndirectStore& store, const Entry& entry);
  bool make_room(render::IndirectStore& store, gpu::Uploader& uploader, const Entry& entry);
  void go_dark(render::IndirectStore& store, gpu::Uploader& uploader, Entry& entry);
  bool try_dark_again(render::IndirectStore& store,
                      const std::map<world::IslandLevel, NearIsland>& islands);

  std::map<world::IslandLevel, Entry> entries_;
  Shown shown_;
  std::optional<std::string> refusal_;
  std::string why_;  // the store's last refusal
};

}  // namespace skerry::game
