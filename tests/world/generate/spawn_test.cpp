#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "world/generate/generate.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

/// The voxels of an island, generated chunk by chunk as they are asked for.
class Voxels {
 public:
  explicit Voxels(const IslandSpec& spec) : generator_(spec) {}

  BlockId at(IVec3 b) {
    const auto chunk = [](int v) { return static_cast<int>(floor_div(v, 64)); };
    const IVec3 c{chunk(b.x), chunk(b.y), chunk(b.z)};
    const auto [entry, fresh] = chunks_.try_emplace(c);
    if (fresh) {
      entry->second.resize(std::size_t{66} * 66 * 66);
      generator_.generate_padded(c, 0, entry->second);
    }
    return entry->second[static_cast<std::size_t>((b.z - c.z * 64 + 1) + 66 * (b.x - c.x * 64 + 1) +
                                                  66 * 66 * (b.y - c.y * 64 + 1))];
  }
  bool solid(IVec3 b) { return block_kind(at(b)) == BlockKind::kOpaque; }
  /// A person fits there, and neither in water nor in a wall.
  bool free(IVec3 b) {
    const BlockId block = at(b);
    return block == kAir || block_kind(block) == BlockKind::kPlant;
  }
  bool stands(IVec3 feet) {
    return solid({feet.x, feet.y - 1, feet.z}) && free(feet) && free({feet.x, feet.y + 1, feet.z});
  }

 private:
  IslandGenerator generator_;
  std::map<IVec3, std::vector<BlockId>> chunks_;
};

/// How far, in steps of a block up or down at the most, one gets from a place: at most 12.
int steps_away(Voxels& voxels, IVec3 start) {
  std::set<IVec3> seen{start};
  std::vector<IVec3> edge{start};
  int farthest = 0;
  while (!edge.empty()) {
    const IVec3 at = edge.back();
    edge.pop_back();
    farthest = std::max({farthest, std::abs(at.x - start.x), std::abs(at.z - start.z)});
    if (farthest >= 12) break;
    for (const IVec3 way : {IVec3{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}})
      for (const int up : {-1, 0, 1}) {
        const IVec3 next{at.x + way.x, at.y + up, at.z + way.z};
        if (voxels.stands(next) && seen.insert(next).second) edge.push_back(next);
      }
  }
  return farthest;
}

/// The part of the sky that an eye sees past its own island, 0 .. 1: rays of equal solid angle.
double open_sky(Voxels& voxels, glm::dvec3 eye) {
  constexpr int kRays = 64;
  constexpr double kGolden = 2.399963229728653, kFar = 40.0, kStep = 0.25;  // radians; blocks
  int open = 0;
  for (int i = 0; i < kRays; ++i) {
    const double up = (i + 0.5) / kRays, flat = std::sqrt(1.0 - up * up);
    const glm::dvec3 way{flat * std::cos(kGolden * i), up, flat * std::sin(kGolden * i)};
    bool blocked = false;
    for (double t = kStep; t < kFar && !blocked; t += kStep) {
      const glm::dvec3 p = eye + t * way;
      blocked = voxels.solid({static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)),
                              static_cast<int>(std::floor(p.z))});
    }
    open += !blocked;
  }
  return static_cast<double>(open) / kRays;
}

/// Whether an eye sees, past its own island, some of a ball of half another island's size.
bool sees(Voxels& voxels, glm::dvec3 eye, glm::dvec3 other, double radius) {
  constexpr double kOwn = 260.0, kStep = 0.5;  // blocks: beyond is no rock of a first island
  constexpr int kRays = 24;
  constexpr double kGolden = 2.399963229728653;
  for (int i = 0; i < kRays; ++i) {
    const double up = 1.0 - 2.0 * (i + 0.5) / kRays, flat = std::sqrt(1.0 - up * up);
    const glm::dvec3 point =
        other +
        0.5 * radius * glm::dvec3(flat * std::cos(kGolden * i), up, flat * std::sin(kGolden * i));
    const glm::dvec3 way = glm::normalize(point - eye);
    bool blocked = false;
    for (double t = kStep; t < kOwn && !blocked; t += kStep) {
      const glm::dvec3 p = eye + t * way;
      const BlockId block =
          voxels.at({static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)),
                     static_cast<int>(std::floor(p.z))});
      blocked = block != kAir && block_kind(block) != BlockKind::kPlant;
    }
    if (!blocked) return true;
  }
  return false;
}

void expect_good_spawn(std::uint64_t seed) {
  const Spawn spawn = spawn_of(seed);
  const auto near = islands_within(seed, spawn.feet, 10.0);
  const auto home = std::find_if(near.begin(), near.end(),
                                 [&](const IslandSpec& s) { return s.id == spawn.island; });
  ASSERT_NE(home, near.end()) << seed;
  EXPECT_EQ(home->yaw_rad, 0.0);
  Voxels voxels(*home);
  const Pose pose = pose_at(*home, 0.0);
  const glm::dvec3 lattice =
      glm::conjugate(pose.rotation) * difference_blocks(spawn.feet, pose.origin);
  const IVec3 feet{static_cast<int>(std::floor(lattice.x)),
                   static_cast<int>(std::lround(lattice.y)),
                   static_cast<int>(std::floor(lattice.z))};
  EXPECT_TRUE(voxels.stands(feet)) << seed;
  EXPECT_GE(steps_away(voxels, feet), 8) << seed;
  // By day it is lit: a third of the sky and more is above.
  EXPECT_GE(open_sky(voxels, lattice + glm::dvec3(0.0, 1.62, 0.0)), 0.34) << seed;
  EXPECT_GE(spawn.yaw_deg, 0.0);
  EXPECT_LT(spawn.yaw_deg, 360.0);
  // A view: some island is seen within 45 degrees of the way the player looks.
  const glm::dvec3 eye = lattice + glm::dvec3(0.0, 1.62, 0.0);
  const auto around = islands_within(seed, spawn.feet, 1000.0);
  EXPECT_TRUE(std::any_of(around.begin(), around.end(), [&](const IslandSpec& other) {
    if (other.id == spawn.island) return false;
    const glm::dvec3 d = difference_blocks(other.origin, spawn.feet);
    const double yaw = spawn.yaw_deg * 3.14159265358979 / 180.0;
    const bool ahead = d.x * std::sin(yaw) + d.z * std::cos(yaw) > 0.707 * std::hypot(d.x, d.z);
    return ahead &&
           sees(voxels, eye,
                glm::conjugate(pose.rotation) * difference_blocks(other.origin, pose.origin),
                other.bounding_radius);
  })) << seed;
}

TEST(Spawn, IsLitGroundWithWaysAndAViewForExtremeSeeds) {
  for (const std::uint64_t seed :
       {std::uint64_t{0}, std::uint64_t{1}, std::numeric_limits<std::uint64_t>::max()})
    expect_good_spawn(seed);
}

TEST(Spawn, IsLitGroundWithWaysAndAViewForTexts) {
  for (const std::string& text : {std::string(), std::string("skerry"), std::string("\xff\xfe\x80"),
                                  std::string(1 << 20, 'x')}) {
    expect_good_spawn(seed_from_text(text));
  }
}

/// SKERRY_SPAWNS: how many.
TEST(Spawn, IsLitGroundWithWaysAndAViewForRandomSeeds) {
  const char* asked = std::getenv("SKERRY_SPAWNS");
  const std::uint64_t seeds = asked ? std::strtoull(asked, nullptr, 10) : 100;
  for (std::uint64_t i = 0; i < seeds; ++i) expect_good_spawn(mix64(i + 1000));
}

}  // namespace
}  // namespace skerry::world
