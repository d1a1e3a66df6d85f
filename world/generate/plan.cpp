#include "world/generate/plan.h"

#include <algorithm>

#include "world/generate/noise.h"
#include "world/generate/sideways.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

bool holds(const Ball& ball, int x, int y, int z) {
  const int dx = x - ball.x;
  const int dy = y - ball.y;
  const int dz = z - ball.z;
  return y >= ball.floor && dx * dx + dy * dy + dz * dz < ball.radius * ball.radius;
}

/// Runs of the main rock, broken by thin bands of the other two.
std::array<BlockId, kBandPeriod> banded(const BiomeType& biome, std::uint32_t seed) {
  std::array<BlockId, kBandPeriod> bands{};
  Rng rng(seed);
  for (std::size_t y = 0; y < bands.size();) {
    const bool band = rng.chance(biome.band_of_256);
    const BlockId rock = band ? biome.rock[static_cast<std::size_t>(rng.in(1, 2))] : biome.rock[0];
    for (int run = band ? rng.in(1, 4) : rng.in(3, 9); run > 0 && y < bands.size(); --run)
      bands[y++] = rock;
  }
  return bands;
}

}  // namespace

IslandPlan::IslandPlan(const IslandSpec& spec)
    : shape(shape_of(spec)), columns(build_columns(shape)) {
  bands = banded(biome(), shape.seed + 301);
  plan_arches(*this);
  plan_caves(*this);
  plan_trees(*this);
  plan_crystals(*this);
  highest = columns.highest;
  lowest = columns.lowest;
  for (const Ball& ball : solids) highest = std::max(highest, ball.y + ball.radius + 1);
  for (const Tree& tree : trees) highest = std::max(highest, tree.y + kTreeHeight);
  for (const Stamp& stamp : stamps) {
    highest = std::max(highest, stamp.y + 1);
    lowest = std::min<int>(lowest, stamp.y);
  }
  highest += 1;  // plants
}

bool IslandPlan::rock_at(int x, int y, int z) const {
  if (!columns.has(x, z)) return false;
  std::size_t i = columns.index(x, z);
  if (columns.ragged[i] > 0) {
    const sideways::Shift shift = sideways::at(shift_seed(), x, y, z);
    i = columns.shifted_index(x, z, i, shift.x, shift.z);
  }
  return y >= columns.bottom[i] && y < columns.top[i];
}

bool IslandPlan::arch_at(int x, int y, int z) const {
  return std::any_of(solids.begin(), solids.end(),
                     [&](const Ball& b) { return holds(b, x, y, z); });
}

int IslandPlan::roof_of(const Ball& hole, std::size_t column) const {
  constexpr int kCover = 5;
  const int roof = columns.roof[column];
  return hole.open ? roof : std::min(roof, columns.top[column] - kCover);
}

bool IslandPlan::solid_at(int x, int y, int z) const {
  const bool rock = rock_at(x, y, z) || arch_at(x, y, z);
  if (!rock || !columns.has(x, z)) return rock;
  const std::size_t column = columns.index(x, z);
  return std::none_of(holes.begin(), holes.end(),
                      [&](const Ball& b) { return holds(b, x, y, z) && y < roof_of(b, column); });
}

void plan_arches(IslandPlan& plan) {
  const Columns& columns = plan.columns;
  for (const Arch& arch : plan.shape.arches) {
    const auto ground = [&columns](int x, int z) {
      return columns.has(x, z) ? columns.top[columns.index(x, z)] : Columns::kNoGround;
    };
    const int y0 = ground(arch.x0, arch.z0);
    const int y1 = ground(arch.x1, arch.z1);
    if (y0 == Columns::kNoGround || y1 == Columns::kNoGround) continue;
    const int length = noise::length(arch.x1 - arch.x0, arch.z1 - arch.z0);
    const int steps = std::max(8, length + 2 * arch.rise);
    for (int i = 0; i <= steps; ++i) {
      const int bow = 4 * i * (steps - i) / steps * arch.rise / steps;
      const int to_foot = std::min(i, steps - i) * 4 / steps;  // 0 at the feet, 2 in the middle
      const int swell = noise::gradient2(plan.shape.seed + 91, i * noise::kOne8, 0, 9) *
                        arch.thickness / (4 * noise::kOne12);
      const int top = std::min(y0 + (y1 - y0) * i / steps + bow, plan.shape.extent.top);
      const int radius = std::max(2, arch.thickness + 1 - to_foot + swell);
      plan.solids.push_back({arch.x0 + (arch.x1 - arch.x0) * i / steps, top - radius,
                             arch.z0 + (arch.z1 - arch.z0) * i / steps, radius,
                             Columns::kNoGround});
    }
  }
}

void plan_trees(IslandPlan& plan) {
  constexpr int kSite = 6;  // one site a square of this many columns
  const Columns& columns = plan.columns;
  const BiomeType& biome = plan.biome();
  const std::uint32_t seed = plan.shape.seed + 401;
  const auto fits = [&](const Tree& tree, int x, int z, std::size_t i) {
    const SkinId skin = columns.skins[i];
    const bool rooted = bears_plants(skin) || skin == SkinId::kSnowyGrass ||
                        (tree.kind == TreeKind::kPalm && skin == SkinId::kSand);
    if (!rooted || columns.water[i] != Columns::kDry || columns.inside[i] < 2) return false;
    const int y = columns.top[i];
    for (const auto& [dx, dz] : {std::pair{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const bool step =
          plan.solid_at(x + dx, y - 1, z + dz) || plan.solid_at(x + dx, y - 2, z + dz);
      if (!step || plan.solid_at(x + dx, y + 1, z + dz)) return false;
    }
    return plan.solid_at(x, y - 1, z) && plan.solid_at(x, y - 2, z) && !plan.solid_at(x, y, z);
  };
  for (int sx = -columns.half / kSite; sx < columns.half / kSite; ++sx) {
    for (int sz = -columns.half / kSite; sz < columns.half / kSite; ++sz) {
      Rng rng(hash2(seed, sx, sz));
      const int x = sx * kSite + rng.in(0, kSite - 2);
      const int z = sz * kSite + rng.in(0, kSite - 2);
      const std::size_t i = columns.index(x, z);
      if (columns.top[i] == Columns::kNoGround) continue;
      // Woods and clearings: a smooth field doubles the chance here and takes it away there.
      const int wood = 2 * noise::kOne12 / 5 +
                       noise::fractal2(seed + 1, x * noise::kOne8, z * noise::kOne8, 46, 2);
      if (!rng.chance(std::clamp(biome.tree_of_256 * wood / (noise::kOne12 * 3 / 4), 0, 230)))
        continue;
      const int pick = rng.in(0, 254);
      const auto kind =
          std::find_if(biome.trees.begin(), biome.trees.end(), [pick](const TreeChance& t) {
            return pick < t.of_256;
          })->kind;
      Tree tree = grown(kind, static_cast<std::uint32_t>(rng.next()));
      if (tree.spread + 3 > columns.inside[i] + kBoxMargin || !fits(tree, x, z, i)) continue;
      tree.x = static_cast<std::int16_t>(x);
      tree.y = columns.top[i];
      tree.z = static_cast<std::int16_t>(z);
      plan.trees.push_back(tree);
    }
  }
}

void plan_crystals(IslandPlan& plan) {
  constexpr int kSite = 9;
  const Columns& columns = plan.columns;
  const BlockId crystal = plan.biome().crystal;
  for (int sx = -columns.half / kSite; sx < columns.half / kSite; ++sx) {
    for (int sz = -columns.half / kSite; sz < columns.half / kSite; ++sz) {
      Rng rng(hash2(plan.shape.seed + 501, sx, sz));
      if (!rng.chance(60)) continue;
      const int x0 = sx * kSite + rng.in(0, kSite - 1);
      const int z0 = sz * kSite + rng.in(0, kSite - 1);
      for (int k = rng.in(2, 5); k > 0; --k) {  // a cluster of shards
        const int x = x0 + rng.in(-1, 1);
        const int z = z0 + rng.in(-1, 1);
        const int length = rng.in(2, 6);
        if (!columns.has(x, z)) continue;
        const std::size_t i = columns.index(x, z);
        if (columns.ragged[i] > 0 || columns.inside[i] < 4) continue;
        for (int d = -1;
             d < length && columns.bottom[i] - 1 - d > -plan.shape.extent.depth - kKeelRoom; ++d) {
          plan.stamps.push_back({static_cast<std::int16_t>(x),
                                 static_cast<std::int16_t>(columns.bottom[i] - 1 - d),
                                 static_cast<std::int16_t>(z), crystal, d >= 0});
        }
      }
    }
  }
}

}  // namespace skerry::world
