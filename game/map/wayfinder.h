// A player's waypoints, home and discoveries while a world is played.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "game/player/player.h"
#include "game/session/journal.h"
#include "game/ui/place_mark.h"
#include "world/islands/world.h"

namespace skerry::game {

/// Something found for the first time.
struct Found {
  enum class What { kKind, kBiome } what;
  std::uint32_t number = 0;  ///< of world::Archetype or world::Biome
  std::uint64_t island = 0;
};

/// Keeps a journal, and knows where its places are by now.
class Wayfinder {
 public:
  /// @param world outlives this. @param spawn is home until another place is.
  Wayfinder(world::World& world, Journal journal, const std::optional<Spot>& spawn);

  const Journal& journal() const { return journal_; }
  /// Whether it has changed since the last call.
  bool take_changed() { return std::exchange(changed_, false); }

  /// What was chosen as home, else the spawn; none: there is none.
  const std::optional<Spot>& home() const { return journal_.home ? journal_.home : spawn_; }

  struct Place {
    ui::PlaceKind kind = ui::PlaceKind::kWaypoint;
    std::string name;  ///< of a waypoint
    Spot spot;
    world::WorldPos feet;  ///< at the time asked for
  };
  /// Home, the ground that held the player last, then the waypoints in their order. What is not
  /// there is left out.
  std::vector<Place> places(const Player& player, double time_s) const;

  /// Marks where the player is. @return false: there are kMaxWaypoints already.
  bool mark(const Player& player, std::string name);
  /// @param waypoint an index into journal().waypoints; what is beyond its end has no effect.
  void rename(std::size_t waypoint, std::string_view name);
  void remove(std::size_t waypoint);
  void make_home(const Spot& spot);

  /// Brings the player there, standing where there is ground and flying where there is none. Loads
  /// the ground if it is not loaded: tens of milliseconds.
  void travel(const Spot& spot, Player& player, const Surroundings& around);

  /// Once a frame. @return what is new of the ground that the player stands on.
  std::vector<Found> note(const Player& player);

 private:
  world::WorldPos feet_at(const Spot& spot, double time_s) const;

  world::World& world_;
  Journal journal_;
  std::optional<Spot> spawn_;
  bool changed_ = false;
};

/// Where a player is.
Spot spot_of(const Player& player);

}  // namespace skerry::game
