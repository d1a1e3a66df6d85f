#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "world/generate/generate.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

/// The voxel of an island at a place in the world, at time 0.
BlockId voxel_at(const IslandSpec& spec, const IslandGenerator& generator, WorldPos place) {
  const Pose pose = pose_at(spec, 0.0);
  const glm::dvec3 lattice = glm::conjugate(pose.rotation) * difference_blocks(place, pose.origin);
  const auto block = [](double v) { return static_cast<int>(std::floor(v)); };
  const IVec3 b{block(lattice.x), block(lattice.y), block(lattice.z)};
  const auto chunk = [](int v) { return static_cast<int>(floor_div(v, 64)); };
  const IVec3 c{chunk(b.x), chunk(b.y), chunk(b.z)};
  std::vector<BlockId> voxels(std::size_t{66} * 66 * 66);
  generator.generate_padded(c, 0, voxels);
  return voxels[static_cast<std::size_t>((b.z - c.z * 64 + 1) + 66 * (b.x - c.x * 64 + 1) +
                                         66 * 66 * (b.y - c.y * 64 + 1))];
}

void expect_good_spawn(std::uint64_t seed) {
  const Spawn spawn = spawn_of(seed);
  const auto near = islands_within(seed, spawn.feet, 10.0);
  const auto home = std::find_if(near.begin(), near.end(),
                                 [&](const IslandSpec& s) { return s.id == spawn.island; });
  ASSERT_NE(home, near.end()) << seed;
  EXPECT_EQ(home->yaw_rad, 0.0);
  const IslandGenerator generator(*home);
  const auto at = [&](double up) {
    return voxel_at(*home, generator, moved(spawn.feet, {0.0, up, 0.0}));
  };
  const auto free = [](BlockId id) { return id == kAir || block_kind(id) == BlockKind::kPlant; };
  EXPECT_EQ(block_kind(at(-0.5)), BlockKind::kOpaque) << seed;
  EXPECT_TRUE(free(at(0.5))) << seed;
  EXPECT_TRUE(free(at(1.5))) << seed;
  EXPECT_GE(spawn.yaw_deg, 0.0);
  EXPECT_LT(spawn.yaw_deg, 360.0);
  // A view: some island stands within 45 degrees of the way the player looks.
  const auto around = islands_within(seed, spawn.feet, 1000.0);
  EXPECT_TRUE(std::any_of(around.begin(), around.end(), [&](const IslandSpec& other) {
    if (other.id == spawn.island) return false;
    const glm::dvec3 d = difference_blocks(other.origin, spawn.feet);
    const double yaw = spawn.yaw_deg * 3.14159265358979 / 180.0;
    return d.x * std::sin(yaw) + d.z * std::cos(yaw) > 0.707 * std::hypot(d.x, d.z);
  })) << seed;
}

TEST(Spawn, StandsOnSolidGroundForExtremeSeeds) {
  for (const std::uint64_t seed :
       {std::uint64_t{0}, std::uint64_t{1}, std::numeric_limits<std::uint64_t>::max()})
    expect_good_spawn(seed);
}

TEST(Spawn, StandsOnSolidGroundForTexts) {
  for (const std::string& text : {std::string(), std::string("skerry"), std::string("\xff\xfe\x80"),
                                  std::string(1 << 20, 'x')}) {
    expect_good_spawn(seed_from_text(text));
  }
}

TEST(Spawn, StandsOnSolidGroundForRandomSeeds) {
  for (std::uint64_t i = 0; i < 200; ++i) expect_good_spawn(mix64(i + 1000));
}

}  // namespace
}  // namespace skerry::world
