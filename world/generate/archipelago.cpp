#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "world/generate/noise.h"
#include "world/generate/shape.h"
#include "world/voxel/hash.h"
#include "world/voxel/island.h"

namespace skerry::world {
namespace {

// The plane is cut into square cells, every second row shifted by half a cell. A cell holds one
// group of islands: a main one and satellites. Every bounding sphere, its drift included, stays
// inside its own cell's prism, so that groups never touch.
constexpr std::int64_t kCell = 880;  // blocks
constexpr int kClearance = 5;        // least gap between spheres, blocks

struct Cell {
  std::int64_t x, z;
};

/// Centre of a cell in blocks.
Cell centre_of(Cell cell) {
  return {cell.x * kCell + (cell.z % 2 != 0 ? kCell / 2 : 0), cell.z * kCell};
}

/// An island's place within its group, before it becomes a spec. Blocks from the cell's centre.
struct Site {
  int x, y, z, radius;
  Archetype archetype;
  Biome biome;
  int drift;   ///< largest distance from its place on any axis
  int sphere;  ///< bounding radius at rest
};

int reach_of(const Site& site) {
  return site.sphere + (site.drift * 7 + 3) / 4;
}

Archetype archetype_for(Biome biome, Rng& rng) {
  using enum Archetype;
  static constexpr std::array<std::array<Archetype, 4>, static_cast<std::size_t>(Biome::kCount)>
      kFit = {{
          {kPlateau, kTwin, kArches, kTerraces},    // meadow
          {kRidge, kRidge, kSpires, kPlateau},      // highland
          {kButtes, kTerraces, kArches, kButtes},   // mesa
          {kPlateau, kRidge, kTwin, kTerraces},     // autumn
          {kTerraces, kPlateau, kArches, kTwin},    // blossom
          {kCrescent, kCrescent, kArches, kTwin},   // tropical
          {kPlateau, kCrescent, kPlateau, kTwin},   // marsh
          {kVolcano, kVolcano, kSpires, kVolcano},  // volcanic
          {kSpires, kTerraces, kArches, kPlateau},  // mycelium
      }};
  return kFit[static_cast<std::size_t>(biome)][static_cast<std::size_t>(rng.in(0, 3))];
}

/// Sizes: most islands are 60 to 260 blocks across; one in ten groups has a giant.
int main_radius(Rng& rng) {
  const int luck = rng.in(0, 99);
  if (luck < 12) return rng.in(190, 290);
  return luck < 55 ? rng.in(105, 165) : rng.in(72, 105);
}

bool fits(const std::vector<Site>& group, const Site& site) {
  const int reach = reach_of(site);
  if (std::max(std::abs(site.x), std::abs(site.z)) + reach + kClearance > kCell / 2) return false;
  return std::all_of(group.begin(), group.end(), [&](const Site& other) {
    const std::int64_t dx = site.x - other.x;
    const std::int64_t dy = site.y - other.y;
    const std::int64_t dz = site.z - other.z;
    const std::int64_t apart = reach + reach_of(other) + kClearance;
    return dx * dx + dy * dy + dz * dz >= apart * apart;
  });
}

Site main_site(Cell cell, Rng& rng) {
  Site site{};
  const bool home = cell.x == 0 && cell.z == 0;
  site.radius = home ? rng.in(96, 124) : main_radius(rng);
  site.biome = static_cast<Biome>(rng.in(0, static_cast<int>(Biome::kCount) - 1));
  site.archetype = archetype_for(site.biome, rng);
  if (home) {  // a friendly first island
    static constexpr std::array<Biome, 4> kFriendly = {Biome::kMeadow, Biome::kBlossom,
                                                       Biome::kAutumn, Biome::kMeadow};
    static constexpr std::array<Archetype, 3> kOpen = {Archetype::kPlateau, Archetype::kTwin,
                                                       Archetype::kTerraces};
    site.biome = kFriendly[static_cast<std::size_t>(rng.in(0, 3))];
    site.archetype = kOpen[static_cast<std::size_t>(rng.in(0, 2))];
  }
  site.sphere = extent_of(site.archetype, site.radius).sphere;
  site.drift = home ? 2 : rng.in(2, 5);
  const int room = std::max(0, static_cast<int>(kCell / 2) - reach_of(site) - kClearance);
  const int wander = home ? 30 : std::min(room, 170);
  site.x = rng.in(-wander, wander);
  site.z = rng.in(-wander, wander);
  site.y = home ? rng.in(-10, 10) : rng.in(-110, 110);
  return site;
}

/// Satellites lie along a chain that winds away from the main island, or around it.
std::vector<Site> group_of(std::uint64_t seed, Cell cell) {
  Rng rng(mix64(seed ^ mix64(static_cast<std::uint64_t>(cell.x) * 0x9e3779b97f4a7c15u ^
                             mix64(static_cast<std::uint64_t>(cell.z)))));
  std::vector<Site> group{main_site(cell, rng)};
  const bool home = cell.x == 0 && cell.z == 0;
  const bool chain = rng.chance(120);
  const int crowd = rng.chance(56) ? 1 : 0;
  const int wanted = home ? 4 : crowd + rng.in(1, 3);
  int direction = rng.in(0, 1023);
  Site previous = group.front();
  for (int tries = 0; tries < 40 && static_cast<int>(group.size()) <= wanted; ++tries) {
    Site site{};
    // The first satellite is close and large: something to long for.
    const int luck = group.size() == 1 ? 99 : rng.in(0, 99);
    site.radius = luck < 20 ? rng.in(12, 26) : luck < 60 ? rng.in(28, 56) : rng.in(56, 96);
    site.biome = rng.chance(150)
                     ? group.front().biome
                     : static_cast<Biome>(rng.in(0, static_cast<int>(Biome::kCount) - 1));
    site.archetype = site.radius < 40 ? Archetype::kShard : archetype_for(site.biome, rng);
    site.sphere = extent_of(site.archetype, site.radius).sphere;
    site.drift = rng.in(2, 5);
    const Site& from = chain ? previous : group.front();
    direction += chain ? rng.in(-130, 130) : rng.in(150, 420);
    const int distance = reach_of(from) + reach_of(site) + rng.in(kClearance, chain ? 30 : 70);
    const int tilt = rng.in(-95, 95);  // up or down from the neighbour, 1/1024 turn
    const int flat = distance * noise::cosine(tilt) / noise::kOne12;
    site.x = from.x + flat * noise::cosine(direction) / noise::kOne12;
    site.z = from.z + flat * noise::sine(direction) / noise::kOne12;
    site.y = std::clamp(from.y + distance * noise::sine(tilt) / noise::kOne12, -220, 220);
    if (!fits(group, site)) continue;
    group.push_back(site);
    previous = site;
  }
  return group;
}

/// A number in [low, high) for motion, which decides no voxel.
double uniform(Rng& rng, double low, double high) {
  return low + (high - low) * static_cast<double>(rng.next() >> 11) * 0x1p-53;
}

IslandSpec spec_of(std::uint64_t seed, Cell cell, std::size_t number, const Site& site) {
  IslandSpec spec;
  spec.id = mix64(mix64(seed + 0x51) ^ mix64(static_cast<std::uint64_t>(cell.x) + 0x52) ^
                  mix64(mix64(static_cast<std::uint64_t>(cell.z) + 0x53) + number));
  spec.seed = mix64(spec.id + 0x54);
  const Cell centre = centre_of(cell);
  spec.origin = {(centre.x + site.x) * kUnitsPerBlock, site.y * kUnitsPerBlock,
                 (centre.z + site.z) * kUnitsPerBlock};
  const Extent extent = extent_of(site.archetype, site.radius);
  const int side = site.radius + kBoxMargin;
  spec.box_min = {-side, -extent.depth - kKeelRoom, -side};
  spec.box_max = {side, extent.top + kTreeRoom, side};
  spec.bounding_radius = site.sphere;
  spec.archetype = static_cast<std::uint32_t>(site.archetype);
  spec.biome = static_cast<std::uint32_t>(site.biome);
  Rng rng(spec.seed + 1);
  spec.drift_amplitude = {uniform(rng, 0.4, 1.0) * site.drift, uniform(rng, 0.3, 0.7) * site.drift,
                          uniform(rng, 0.4, 1.0) * site.drift};
  spec.drift_period_s = uniform(rng, 180.0, 540.0);
  spec.drift_phase_rad = uniform(rng, 0.0, 2.0 * std::numbers::pi);
  const bool home = cell.x == 0 && cell.z == 0 && number == 0;
  if (!home) {  // home keeps its heading, so that a new player's bearings hold
    spec.yaw_rad = uniform(rng, 0.0, 2.0 * std::numbers::pi);
    const double turn_s = uniform(rng, 3600.0, 3.0 * 3600.0);
    spec.spin_rad_per_s = (rng.chance(128) ? 2.0 : -2.0) * std::numbers::pi / turn_s;
  }
  return spec;
}

}  // namespace

std::vector<IslandSpec> islands_within(std::uint64_t seed, WorldPos centre, double radius_blocks) {
  struct Found {
    double distance;
    IslandSpec spec;
  };
  std::vector<Found> found;
  if (!(radius_blocks >= 0.0)) return {};
  const auto units =
      static_cast<std::int64_t>(std::min(radius_blocks, static_cast<double>(kMaxBlock)) *
                                static_cast<double>(kUnitsPerBlock));
  const auto cell_at = [](std::int64_t at) {
    return floor_div(floor_div(at, kUnitsPerBlock) + kCell / 2, kCell);
  };
  for (std::int64_t cz = cell_at(centre.z - units); cz <= cell_at(centre.z + units); ++cz) {
    const std::int64_t shift = (cz % 2 != 0 ? kCell / 2 : 0) * kUnitsPerBlock;
    for (std::int64_t cx = cell_at(centre.x - units - shift);
         cx <= cell_at(centre.x + units - shift); ++cx) {
      const std::vector<Site> group = group_of(seed, {cx, cz});
      for (std::size_t i = 0; i < group.size(); ++i) {
        IslandSpec spec = spec_of(seed, {cx, cz}, i, group[i]);
        const glm::dvec3 away = difference_blocks(spec.origin, centre);
        const double distance = std::sqrt(away.x * away.x + away.y * away.y + away.z * away.z);
        if (distance - spec.bounding_radius <= radius_blocks) found.push_back({distance, spec});
      }
    }
  }
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.spec.id < b.spec.id;
  });
  std::vector<IslandSpec> specs;
  specs.reserve(found.size());
  for (const Found& f : found) specs.push_back(f.spec);
  return specs;
}

}  // namespace skerry::world
