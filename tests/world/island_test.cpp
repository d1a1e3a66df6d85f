#include "world/voxel/island.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "world/generate/biome.h"

namespace skerry::world {
namespace {

constexpr std::uint64_t kLastSeed = std::numeric_limits<std::uint64_t>::max();

double distance_blocks(WorldPos a, WorldPos b) {
  const glm::dvec3 d = difference_blocks(a, b);
  return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

TEST(SeedText, DecimalNumbersAreTakenAsTheyAre) {
  EXPECT_EQ(seed_from_text("0"), 0u);
  EXPECT_EQ(seed_from_text("1"), 1u);
  EXPECT_EQ(seed_from_text("18446744073709551615"), kLastSeed);
}

TEST(SeedText, OtherTextsHashApart) {
  const std::vector<std::string> texts = {"",
                                          " ",
                                          "-1",
                                          "+1",
                                          "1 ",
                                          "0x10",
                                          "1.0",
                                          "18446744073709551616",
                                          "skerry",
                                          "Skerry",
                                          std::string("\0", 1),
                                          "\xff\xfe\x80",
                                          std::string(1 << 20, 'a')};
  std::set<std::uint64_t> seeds;
  for (const std::string& text : texts) seeds.insert(seed_from_text(text));
  EXPECT_EQ(seeds.size(), texts.size());
  EXPECT_EQ(seed_from_text("skerry"), seed_from_text(std::string("skerry")));
}

TEST(Archipelago, TenToTwentyFiveIslandsLieAroundTheOrigin) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const std::size_t count = islands_within(seed, {}, 1000.0).size();
    EXPECT_GE(count, 10u) << seed;
    EXPECT_LE(count, 25u) << seed;
  }
}

TEST(Archipelago, AnswersDoNotDependOnTheQuestion) {
  const auto wide = islands_within(9, {}, 3000.0);
  const WorldPos centre{500 * kUnitsPerBlock, 40 * kUnitsPerBlock, -700 * kUnitsPerBlock};
  std::vector<std::uint64_t> expected;
  for (const IslandSpec& spec : wide) {
    if (distance_blocks(spec.origin, centre) - spec.bounding_radius <= 900.0)
      expected.push_back(spec.id);
  }
  const auto narrow = islands_within(9, centre, 900.0);
  std::vector<std::uint64_t> found;
  for (const IslandSpec& spec : narrow) found.push_back(spec.id);
  for (std::size_t i = 1; i < narrow.size(); ++i) {
    EXPECT_LE(distance_blocks(narrow[i - 1].origin, centre),
              distance_blocks(narrow[i].origin, centre));
  }
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, expected);
  EXPECT_FALSE(found.empty());
}

TEST(Archipelago, SenselessRadiiFindNothing) {
  EXPECT_TRUE(islands_within(1, {}, -1.0).empty());
  EXPECT_TRUE(islands_within(1, {}, std::nan("")).empty());
}

TEST(Archipelago, ReachesToTheEdgeOfTheWorld) {
  const std::int64_t far = kMaxBlock * kUnitsPerBlock;
  EXPECT_GE(islands_within(3, {far, 0, -far}, 1500.0).size(), 10u);
}

TEST(Archipelago, ManyIslandsShowEveryBiomeAndAllSizes) {
  std::set<std::uint32_t> biomes;
  std::set<std::uint64_t> ids;
  int small = 0, middle = 0, large = 0;
  const auto specs = islands_within(11, {}, 6000.0);
  ASSERT_GE(specs.size(), 300u);
  for (const IslandSpec& spec : specs) {
    biomes.insert(spec.biome);
    ids.insert(spec.id);
    const int across = spec.box_max.x - spec.box_min.x;
    EXPECT_LE(across, 620);
    EXPECT_GE(across, 20);
    (across < 60 ? small : across <= 300 ? middle : large) += 1;
  }
  EXPECT_EQ(biomes.size(), static_cast<std::size_t>(Biome::kCount));
  EXPECT_GE(biomes.size(), 6u);
  EXPECT_EQ(ids.size(), specs.size());
  EXPECT_GT(middle, small + large);
  EXPECT_GT(small, 0);
  EXPECT_GT(large, 0);
}

// Every minute of an hour, for 400 islands.
TEST(Archipelago, BoundingSpheresNeverTouch) {
  const auto specs = islands_within(kLastSeed, {}, 5000.0);
  ASSERT_GE(specs.size(), 200u);
  for (int minute = 0; minute <= 60; minute += 3) {
    std::vector<WorldPos> origins;
    for (const IslandSpec& spec : specs) origins.push_back(pose_at(spec, minute * 60.0).origin);
    for (std::size_t i = 0; i < specs.size(); ++i) {
      for (std::size_t j = i + 1; j < specs.size(); ++j) {
        ASSERT_GT(distance_blocks(origins[i], origins[j]),
                  specs[i].bounding_radius + specs[j].bounding_radius);
      }
    }
  }
}

TEST(Pose, MovesWithoutJumpsAndStaysNear) {
  for (const IslandSpec& spec : islands_within(4, {}, 1500.0)) {
    for (double t = 0.0; t < 4000.0; t += 37.0) {
      const Pose a = pose_at(spec, t);
      const Pose b = pose_at(spec, t + 0.1);
      EXPECT_LT(distance_blocks(a.origin, b.origin), 0.05);
      EXPECT_GT(std::abs(glm::dot(a.rotation, b.rotation)), 1.0 - 1e-6);
      EXPECT_NEAR(glm::length(a.rotation), 1.0, 1e-12);
      EXPECT_LE(distance_blocks(a.origin, spec.origin), glm::length(spec.drift_amplitude) + 1e-4);
    }
  }
}

TEST(Pose, TurnsAboutTheVerticalByTheHeading) {
  IslandSpec spec;
  spec.yaw_rad = 0.5;
  spec.spin_rad_per_s = 0.01;
  const glm::dvec3 forward = pose_at(spec, 30.0).rotation * glm::dvec3{0.0, 0.0, 1.0};
  EXPECT_NEAR(forward.x, std::sin(0.8), 1e-12);  // docs/conventions.md: yaw 90 looks along +x
  EXPECT_NEAR(forward.z, std::cos(0.8), 1e-12);
  EXPECT_NEAR(forward.y, 0.0, 1e-12);
}

TEST(Pose, StaysSoundAtHugeTimes) {
  const IslandSpec spec = islands_within(4, {}, 1500.0).back();
  for (const double t : {1e9, 1e12, -1e12, 1e300}) {
    const Pose pose = pose_at(spec, t);
    EXPECT_NEAR(glm::length(pose.rotation), 1.0, 1e-12) << t;
    EXPECT_LE(distance_blocks(pose.origin, spec.origin), glm::length(spec.drift_amplitude) + 1e-4)
        << t;
  }
  // One drift period later the path has closed, also far from time 0 (the rounding of t is all that
  // differs).
  EXPECT_LT(
      distance_blocks(pose_at(spec, 1e9).origin, pose_at(spec, 1e9 + spec.drift_period_s).origin),
      1e-4);
}

}  // namespace
}  // namespace skerry::world
