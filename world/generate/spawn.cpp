#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/check.h"
#include "world/generate/noise.h"
#include "world/generate/plan.h"
#include "world/island.h"

namespace skerry::world {
namespace {

constexpr int kViewRange = 48;  // blocks of nearby ground that could hide the view

/// Level, dry ground in the open: two free voxels, no cliff, no tree close by.
bool can_stand(const IslandPlan& plan, int x, int z) {
  const Columns& columns = plan.columns;
  const std::size_t i = columns.index(x, z);
  if (columns.top[i] == Columns::kNoGround || columns.inside[i] < 5) return false;
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dz = -1; dz <= 1; ++dz) {
      const std::size_t n = columns.index(x + dx, z + dz);
      if (columns.top[n] != columns.top[i] || columns.water[n] != Columns::kDry ||
          columns.ragged[n] > 0)
        return false;
    }
  }
  constexpr int kTreeFree = kTreeReach + 2;
  const bool clear = std::none_of(plan.trees.begin(), plan.trees.end(), [&](const Tree& tree) {
    return std::abs(tree.x - x) < kTreeFree && std::abs(tree.z - z) < kTreeFree;
  });
  const int y = columns.top[i];
  return clear && plan.solid_at(x, y - 1, z) && !plan.solid_at(x, y, z) &&
         !plan.solid_at(x, y + 1, z);
}

/// How much of the way towards (dx, dz), a Q12 direction, is free of ground and trees at eye
/// height: 0..kViewRange.
int open_way(const IslandPlan& plan, int x, int z, int dx, int dz) {
  const Columns& columns = plan.columns;
  const int eye = columns.top[columns.index(x, z)] + 2;
  for (int step = 1; step <= kViewRange; ++step) {
    const int px = x + dx * step / noise::kOne12;
    const int pz = z + dz * step / noise::kOne12;
    if (!columns.has(px, pz)) return kViewRange;
    if (columns.top[columns.index(px, pz)] >= eye) return step;
    const bool tree = std::any_of(plan.trees.begin(), plan.trees.end(), [&](const Tree& t) {
      return std::abs(t.x - px) <= t.spread && std::abs(t.z - pz) <= t.spread && eye >= t.y &&
             eye <= t.y + t.height + t.spread;
    });
    if (tree) return step;
  }
  return kViewRange;
}

struct View {
  int x = 0, z = 0, score = -1;
  glm::dvec3 towards{};
};

}  // namespace

Spawn spawn_of(std::uint64_t seed) {
  const std::vector<IslandSpec> near = islands_within(seed, WorldPos{}, 700.0);
  const auto home = std::find_if(near.begin(), near.end(),
                                 [](const IslandSpec& s) { return s.spin_rad_per_s == 0.0; });
  SKERRY_ASSERT(home != near.end());
  const IslandPlan plan(*home);
  const int reach = plan.shape.extent.radius;
  View best;
  for (int spacing = 5; best.score < 0 && spacing > 0; spacing -= 2) {
    for (int x = -reach; x < reach; x += spacing) {
      for (int z = -reach; z < reach; z += spacing) {
        if (!can_stand(plan, x, z)) continue;
        const int edge = plan.columns.inside[plan.columns.index(x, z)];
        for (const IslandSpec& other : near) {
          if (&other == &*home) continue;
          const glm::dvec3 away =
              difference_blocks(other.origin, home->origin) - glm::dvec3{x, 0, z};
          const double flat = std::hypot(away.x, away.z);
          if (flat < 60.0 || std::abs(away.y) > 0.45 * flat) continue;
          const auto part = [flat](double d) { return static_cast<int>(d / flat * noise::kOne12); };
          // Big and near is a sight; so is standing near the edge.
          const int sight = static_cast<int>(other.bounding_radius * 300.0 / flat);
          const int score = 8 * open_way(plan, x, z, part(away.x), part(away.z)) +
                            std::min(sight, 250) - 6 * std::abs(edge - 10);
          if (score > best.score) best = {x, z, score, away};
        }
        if (best.score < 0) best = {x, z, 0, {static_cast<double>(x), 0.0, static_cast<double>(z)}};
      }
    }
  }
  SKERRY_ASSERT(best.score >= 0);
  const Pose pose = pose_at(*home, 0.0);
  const int ground = plan.columns.top[plan.columns.index(best.x, best.z)];
  const glm::dvec3 feet = pose.rotation * glm::dvec3{best.x + 0.5, ground, best.z + 0.5};
  Spawn spawn;
  spawn.feet = moved(pose.origin, feet);
  spawn.yaw_deg = std::atan2(best.towards.x, best.towards.z) * 180.0 / std::numbers::pi;
  spawn.island = home->id;
  return spawn;
}

}  // namespace skerry::world
