#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/core/check.h"
#include "world/generate/noise.h"
#include "world/generate/plan.h"
#include "world/voxel/island.h"

namespace skerry::world {
namespace {

constexpr int kViewRange = 48;   // blocks of nearby ground that could hide the view
constexpr int kDirections = 64;  // of the compass

/// Heights of all that blocks a view: ground, crowns, arches. One a column.
std::vector<std::int16_t> skyline_of(const IslandPlan& plan) {
  const Columns& columns = plan.columns;
  std::vector<std::int16_t> skyline = columns.top;
  const auto raise = [&](int cx, int cz, int reach, int height) {
    for (int x = std::max(cx - reach, -columns.half); x <= std::min(cx + reach, columns.half - 1);
         ++x) {
      for (int z = std::max(cz - reach, -columns.half); z <= std::min(cz + reach, columns.half - 1);
           ++z) {
        std::int16_t& top = skyline[columns.index(x, z)];
        top = std::max(top, static_cast<std::int16_t>(height));
      }
    }
  };
  for (const Tree& tree : plan.trees)
    raise(tree.x, tree.z, tree.spread + 1, tree.y + tree.height + tree.spread);
  for (const Ball& ball : plan.solids) raise(ball.x, ball.z, ball.radius, ball.y + ball.radius);
  return skyline;
}

/// Level, dry ground in the open: free voxels above, no cliff, tree or cave.
bool can_stand(const IslandPlan& plan, const std::vector<std::int16_t>& skyline, int x, int z) {
  const Columns& columns = plan.columns;
  const std::size_t i = columns.index(x, z);
  if (columns.top[i] == Columns::kNoGround || columns.inside[i] < 5) return false;
  const int y = columns.top[i];
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dz = -1; dz <= 1; ++dz) {
      const std::size_t n = columns.index(x + dx, z + dz);
      const bool open = columns.top[n] == y && skyline[n] == y && columns.water[n] == Columns::kDry;
      if (!open || !plan.solid_at(x + dx, y - 1, z + dz)) return false;
      for (int up = 0; up < 3; ++up) {
        if (plan.solid_at(x + dx, y + up, z + dz)) return false;
      }
    }
  }
  return true;
}

/// How much of the way in a direction rises by less than a block: 0..kViewRange.
int open_way(const Columns& columns, const std::vector<std::int16_t>& skyline, int x, int z,
             int angle) {
  const int rise = columns.top[columns.index(x, z)] + 1;
  for (int step = 2; step <= kViewRange; step += 2) {
    const int px = x + noise::sine(angle) * step / noise::kOne12;
    const int pz = z + noise::cosine(angle) * step / noise::kOne12;
    if (!columns.has(px, pz)) break;
    if (skyline[columns.index(px, pz)] >= rise) return step;
  }
  return kViewRange;
}

/// How much of the sight an island gives: its apparent size, little when it lies far above or
/// below.
int sight_of(const IslandSpec& other, glm::dvec3 away) {
  const double flat = std::hypot(away.x, away.z);
  if (flat < 1.0 || std::abs(away.y) > 0.6 * flat) return 0;
  return static_cast<int>(std::min(other.bounding_radius * 1000.0 / flat, 600.0));
}

/// What each direction of the compass has to show in a field of view of a quarter turn.
std::array<int, kDirections> sights_of(const IslandSpec& home,
                                       const std::vector<IslandSpec>& near) {
  std::array<int, kDirections> sights{};
  for (int direction = 0; direction < kDirections; ++direction) {
    const double angle = direction * 2.0 * std::numbers::pi / kDirections;
    for (const IslandSpec& other : near) {
      const glm::dvec3 away = difference_blocks(other.origin, home.origin);
      const double flat = std::max(1.0, std::hypot(away.x, away.z));
      const double along = (away.x * std::sin(angle) + away.z * std::cos(angle)) / flat;
      if (along > 0.75)
        sights[direction] += static_cast<int>(along * along * sight_of(other, away));
    }
  }
  return sights;
}

struct View {
  int x = 0, z = 0;
  int direction = 0;  ///< of the compass
  int score = -1;
};

/// Where to stand and look: near the brink, much to see, the way ahead open to both sides.
View best_view(const IslandPlan& plan, const std::array<int, kDirections>& sights) {
  const Columns& columns = plan.columns;
  const std::vector<std::int16_t> skyline = skyline_of(plan);
  const int most = std::max(1, *std::max_element(sights.begin(), sights.end()));
  const int reach = plan.shape.extent.radius;
  View best;
  for (int spacing = 5; best.score < 0 && spacing > 0; spacing -= 2) {
    for (int x = -reach; x < reach; x += spacing) {
      for (int z = -reach; z < reach; z += spacing) {
        if (!can_stand(plan, skyline, x, z)) continue;
        const int inland = std::max(0, columns.inside[columns.index(x, z)] - 9);
        for (int direction = 0; direction < kDirections; direction += 2) {
          const int angle = direction * (1024 / kDirections);
          const int sight = sights[static_cast<std::size_t>(direction)];
          if (sight * 2 < most) continue;
          const int ahead = (x * noise::sine(angle) + z * noise::cosine(angle)) / noise::kOne12;
          int score = 2000 + 900 * sight / most + 400 * ahead / reach - 8 * inland;
          for (const int turn : {-112, -64, -32, 0, 32, 64, 112})
            score += 6 * open_way(columns, skyline, x, z, angle + turn);
          if (score > best.score) best = {x, z, direction, score};
        }
      }
    }
  }
  return best;
}

}  // namespace

Spawn spawn_of(std::uint64_t seed) {
  const std::vector<IslandSpec> near = islands_within(seed, WorldPos{}, 900.0);
  const auto home = std::find_if(near.begin(), near.end(),
                                 [](const IslandSpec& s) { return s.spin_rad_per_s == 0.0; });
  SKERRY_ASSERT(home != near.end());
  const IslandPlan plan(*home);
  const View best = best_view(plan, sights_of(*home, near));
  SKERRY_ASSERT(best.score >= 0);
  const Pose pose = pose_at(*home, 0.0);
  const int ground = plan.columns.top[plan.columns.index(best.x, best.z)];
  const glm::dvec3 feet = pose.rotation * glm::dvec3{best.x + 0.5, ground, best.z + 0.5};
  Spawn spawn;
  spawn.feet = moved(pose.origin, feet);
  spawn.yaw_deg = best.direction * 360.0 / kDirections;
  spawn.island = home->id;
  return spawn;
}

}  // namespace skerry::world
