#include "game/map/wayfinder.h"

#include <algorithm>
#include <cmath>

#include "world/generate/biome.h"
#include "world/generate/shape.h"

namespace skerry::game {
namespace {

world::IVec3 voxel_of(const LatticePos& feet) {
  const auto block = [](std::int64_t units) {
    return static_cast<std::int32_t>(world::floor_div(units, kLatticeBlock));
  };
  return {block(feet.x), block(feet.y), block(feet.z)};
}

}  // namespace

Spot spot_of(const Player& player) {
  const PlayerState state = player.state();
  return {state.island, state.island ? state.lattice : LatticePos{0}, state.feet};
}

Wayfinder::Wayfinder(world::World& world, Journal journal, const std::optional<Spot>& spawn)
    : world_(world), journal_(std::move(journal)), spawn_(spawn) {}

/// An island that is not known by now becomes so from its neighbourhood; one that is gone leaves
/// the place where it was.
world::WorldPos Wayfinder::feet_at(const Spot& spot, double time_s) const {
  if (!spot.island) return spot.place;
  std::optional<world::Pose> pose = world_.pose(*spot.island, time_s);
  if (!pose) {
    (void)world_.islands_near(spot.place, 2.0 * world::kMaxIslandDriftBlocks, time_s);
    pose = world_.pose(*spot.island, time_s);
  }
  return pose ? world::moved(pose->origin, pose->rotation * lattice_blocks(spot.lattice))
              : spot.place;
}

std::vector<Wayfinder::Place> Wayfinder::places(const Player& player, double time_s) const {
  std::vector<Place> out;
  const auto add = [&](ui::PlaceKind kind, std::string name, const Spot& spot) {
    out.push_back({kind, std::move(name), spot, feet_at(spot, time_s)});
  };
  if (home()) add(ui::PlaceKind::kHome, {}, *home());
  if (const std::optional<Footing> ground = player.state().safe)
    add(ui::PlaceKind::kGround, {}, {ground->island, ground->lattice, player.feet()});
  for (const Waypoint& waypoint : journal_.waypoints)
    add(ui::PlaceKind::kWaypoint, waypoint.name, waypoint.spot);
  return out;
}

bool Wayfinder::mark(const Player& player, std::string name) {
  if (journal_.waypoints.size() >= kMaxWaypoints) return false;
  journal_.waypoints.push_back({{}, spot_of(player)});
  rename(journal_.waypoints.size() - 1, name);
  changed_ = true;
  return true;
}

void Wayfinder::rename(std::size_t waypoint, std::string_view name) {
  if (waypoint >= journal_.waypoints.size()) return;
  std::string& kept = journal_.waypoints[waypoint].name;
  const std::string before = std::exchange(kept, name.substr(0, kMaxWaypointBytes));
  changed_ |= kept != before;
}

void Wayfinder::remove(std::size_t waypoint) {
  if (waypoint >= journal_.waypoints.size()) return;
  journal_.waypoints.erase(journal_.waypoints.begin() + static_cast<std::ptrdiff_t>(waypoint));
  changed_ = true;
}

void Wayfinder::make_home(const Spot& spot) {
  journal_.home = spot;
  changed_ = true;
}

void Wayfinder::travel(const Spot& spot, Player& player, const Surroundings& around) {
  const world::WorldPos feet = feet_at(spot, player.tick_time_s());
  if (spot.island) {
    // The voxel under the feet decides whether there is ground.
    const world::IVec3 at = voxel_of(spot.lattice);
    for (const int down : {0, 1})
      world_.ensure_chunk(*spot.island, world::chunk_of({at.x, at.y - down, at.z}));
    if (player.stand_on({*spot.island, spot.lattice}, around)) return;
  }
  player.fly_to(feet, around);
}

std::vector<Found> Wayfinder::note(const Player& player) {
  std::vector<Found> found;
  const std::optional<std::uint64_t> island = player.frame_island();
  if (!island || !player.on_ground() || player.mode() != MoveMode::kWalk) return found;
  Discoveries& known = journal_.found;
  const Discoveries before = known;
  const std::int64_t height = world::floor_div(
      player.feet().y - world_.origin().y + world::kUnitsPerBlock / 2, world::kUnitsPerBlock);
  known.highest = std::max(known.highest.value_or(height), height);
  known.deepest = std::min(known.deepest.value_or(height), height);
  const std::optional<world::IslandSpec> spec = world_.island(*island);
  if (spec && !world_.is_added(*island)) {
    const auto first = [&](std::uint32_t& seen, std::uint32_t number, Found::What what) {
      if ((seen >> number & 1u) == 0) found.push_back({what, number, *island});
      seen |= 1u << number;
    };
    first(known.kinds, spec->archetype, Found::What::kKind);
    first(known.biomes, spec->biome, Found::What::kBiome);
  }
  changed_ |= known != before;
  return found;
}

}  // namespace skerry::game
