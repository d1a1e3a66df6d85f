#include "game/session/journal.h"

#include <algorithm>

#include "game/session/saved_play.h"

namespace skerry::game {
namespace {

constexpr std::string_view kJournals = "journals";
constexpr std::int64_t kFarthestLattice = std::int64_t{1} << 52;  // 2^20 blocks of 2^32 units
constexpr std::int64_t kMaxUnits = world::kMaxBlock * world::kUnitsPerBlock;

bool within(std::int64_t value, std::int64_t most) {
  return value >= -most && value <= most;
}

bool sound(const Spot& spot) {
  const LatticePos& l = spot.lattice;
  const world::WorldPos& p = spot.place;
  const bool in_lattice = within(l.x, kFarthestLattice) && within(l.y, kFarthestLattice) &&
                          within(l.z, kFarthestLattice);
  return in_lattice && (spot.island || l == LatticePos{0}) && within(p.x, kMaxUnits) &&
         within(p.y, kMaxUnits) && within(p.z, kMaxUnits);
}

void encode(const Spot& spot, world::ByteWriter& out) {
  out.u8(spot.island.has_value());
  out.u64(spot.island.value_or(0));
  for (int axis = 0; axis < 3; ++axis) out.i64(spot.lattice[axis]);
  for (const std::int64_t axis : {spot.place.x, spot.place.y, spot.place.z}) out.i64(axis);
}

Spot decode_spot(world::ByteReader& in) {
  Spot spot;
  const bool on_island = in.u8() != 0;
  const std::uint64_t island = in.u64();
  if (on_island) spot.island = island;
  for (int axis = 0; axis < 3; ++axis) spot.lattice[axis] = in.i64();
  for (std::int64_t* axis : {&spot.place.x, &spot.place.y, &spot.place.z}) *axis = in.i64();
  return spot;
}

void encode(const std::optional<std::int64_t>& value, world::ByteWriter& out) {
  out.u8(value.has_value());
  out.i64(value.value_or(0));
}

std::optional<std::int64_t> decode_height(world::ByteReader& in) {
  const bool there = in.u8() != 0;
  const std::int64_t value = in.i64();
  return there ? std::optional(value) : std::nullopt;
}

}  // namespace

bool fits_file(const Journal& journal) {
  const bool names =
      std::all_of(journal.waypoints.begin(), journal.waypoints.end(), [](const Waypoint& waypoint) {
        return waypoint.name.size() <= kMaxWaypointBytes && sound(waypoint.spot);
      });
  const auto height = [](const std::optional<std::int64_t>& value) {
    return !value || within(*value, 2 * world::kMaxBlock);
  };
  return journal.waypoints.size() <= kMaxWaypoints && names &&
         (!journal.home || sound(*journal.home)) && height(journal.found.highest) &&
         height(journal.found.deepest);
}

void encode_journal(const Journal& journal, world::ByteWriter& out) {
  out.u32(static_cast<std::uint32_t>(journal.waypoints.size()));
  for (const Waypoint& waypoint : journal.waypoints) {
    out.text(waypoint.name);
    encode(waypoint.spot, out);
  }
  out.u8(journal.home.has_value());
  encode(journal.home.value_or(Spot{}), out);
  out.u32(journal.found.kinds);
  out.u32(journal.found.biomes);
  encode(journal.found.highest, out);
  encode(journal.found.deepest, out);
}

std::optional<Journal> decode_journal(world::ByteReader& in) {
  Journal journal;
  const std::uint32_t count = in.u32();
  if (count > kMaxWaypoints) return std::nullopt;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::string name = in.text(kMaxWaypointBytes);
    journal.waypoints.push_back({std::move(name), decode_spot(in)});
  }
  const bool has_home = in.u8() != 0;
  const Spot home = decode_spot(in);
  if (has_home) journal.home = home;
  journal.found.kinds = in.u32();
  journal.found.biomes = in.u32();
  journal.found.highest = decode_height(in);
  journal.found.deepest = decode_height(in);
  if (in.cut_short() || !fits_file(journal)) return std::nullopt;
  return journal;
}

void put_journals(world::WorldFile::Transaction& transaction, const Journals& journals) {
  world::ByteWriter out;
  out.u32(static_cast<std::uint32_t>(journals.size()));
  for (const auto& [player, journal] : journals) {
    out.text(player);
    encode_journal(journal, out);
  }
  transaction.put_value(kJournals, out.bytes());
}

Journals saved_journals(world::WorldFile& file) {
  Journals journals;
  const auto bytes = file.value(kJournals);
  if (!bytes) return journals;
  world::ByteReader in(*bytes);
  const std::uint32_t count = in.u32();
  bool good = count <= kMaxPlayers;
  for (std::uint32_t i = 0; good && i < count; ++i) {
    std::string player = in.text(kMaxPlayerBytes);
    std::optional<Journal> journal = decode_journal(in);
    good = journal.has_value();
    if (good) journals.insert_or_assign(std::move(player), *std::move(journal));
  }
  if (!good || !in.done())
    file.note_damage("the saved world has damaged waypoints or discoveries: they are left out");
  return journals;
}

}  // namespace skerry::game
