// What a player keeps of a world besides their place: waypoints, a home, discoveries.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "game/player/player_state.h"
#include "world/store/bytes.h"
#include "world/store/world_file.h"

namespace skerry::game {

inline constexpr std::size_t kMaxWaypoints = 64;
inline constexpr std::size_t kMaxWaypointBytes = 64;  ///< of a name

/// A place of the feet. On an island it moves and turns with it.
struct Spot {
  std::optional<std::uint64_t> island;
  LatticePos lattice{0};  ///< in the island's frame; zero without an island
  world::WorldPos place;  ///< in the world, when it was noted
  bool operator==(const Spot&) const = default;
};

struct Waypoint {
  std::string name;  ///< UTF-8
  Spot spot;
  bool operator==(const Waypoint&) const = default;
};

/// What a player has seen of a world on foot.
struct Discoveries {
  std::uint32_t kinds = 0;   ///< a bit for each world::Archetype
  std::uint32_t biomes = 0;  ///< a bit for each world::Biome
  /// Ground stood on, whole blocks above the world's own origin.
  std::optional<std::int64_t> highest, deepest;
  bool operator==(const Discoveries&) const = default;
};

struct Journal {
  std::vector<Waypoint> waypoints;  ///< at most kMaxWaypoints
  std::optional<Spot> home;         ///< none: the spawn
  Discoveries found;
  bool operator==(const Journal&) const = default;
};

/// By the player's name; the empty name is the player of a world that is played alone.
using Journals = std::map<std::string, Journal>;

/// Whether a journal is one that a file may hold: counts, lengths of names, places within the
/// world.
bool fits_file(const Journal& journal);
/// @pre fits_file(journal)
void encode_journal(const Journal& journal, world::ByteWriter& out);
/// Takes any bytes. None: no encoder wrote them.
std::optional<Journal> decode_journal(world::ByteReader& in);

/// @pre at most kMaxPlayers names of at most kMaxPlayerBytes, journals that fit.
void put_journals(world::WorldFile::Transaction& transaction, const Journals& journals);
/// What is behind damage is left out, with a line in WorldFile::damage().
Journals saved_journals(world::WorldFile& file);

}  // namespace skerry::game
