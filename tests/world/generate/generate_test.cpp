#include "world/generate/generate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <thread>

#include "tests/world/generate/island_voxels.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

constexpr std::uint64_t kLastSeed = std::numeric_limits<std::uint64_t>::max();

std::uint64_t hash_of(const std::vector<BlockId>& voxels) {
  std::uint64_t hash = 0;
  for (const BlockId id : voxels) hash = hash * 0x9e3779b97f4a7c15u + id + 1;
  return mix64(hash);
}

std::uint64_t hash_of_chunk(const IslandGenerator& generator, IVec3 chunk, int level) {
  std::vector<BlockId> voxels(kPaddedCount);
  generator.generate_padded(chunk, level, voxels);
  return hash_of(voxels);
}

/// All levels of the two islands nearest to the origin, chunk order included.
std::uint64_t hash_of_seed(std::uint64_t seed, int threads) {
  std::uint64_t hash = 0;
  auto specs = islands_within(seed, {}, 700.0);
  specs.resize(std::min<std::size_t>(specs.size(), 2));
  for (const IslandSpec& spec : specs) {
    const IslandGenerator generator(spec);
    for (int level = 0; level <= 4; ++level) {
      const auto chunks = generator.chunks(level);
      std::vector<std::uint64_t> hashes(chunks.size());
      std::vector<std::jthread> workers;
      for (int t = 0; t < threads; ++t) {
        workers.emplace_back([&, t] {
          for (std::size_t i = static_cast<std::size_t>(t); i < chunks.size();
               i += static_cast<std::size_t>(threads)) {
            hashes[i] = hash_of_chunk(generator, chunks[i], level);
          }
        });
      }
      workers.clear();
      for (const std::uint64_t h : hashes) hash = mix64(hash ^ h) + spec.id;
    }
  }
  return hash;
}

TEST(Generate, VoxelsHashToTheRecordedValues) {
  EXPECT_EQ(hash_of_seed(0, 1), 0x55a1cc29afc5dd7eu);
  EXPECT_EQ(hash_of_seed(1, 1), 0x70c295fd123d1e07u);
  EXPECT_EQ(hash_of_seed(kLastSeed, 1), 0xb85ba945c1185fa7u);
  EXPECT_EQ(hash_of_seed(seed_from_text("skerry"), 1), 0x5aeff5ef227b9d02u);
}

TEST(Generate, ThreadsDoNotChangeVoxels) {
  EXPECT_EQ(hash_of_seed(5, 8), hash_of_seed(5, 1));
}

TEST(Generate, EverySilhouetteHashesApart) {
  std::vector<std::uint64_t> hashes;
  for (const IslandSpec& spec : one_of_each(50))
    hashes.push_back(hash_of_chunk(IslandGenerator(spec), {0, 0, 0}, 0));
  std::sort(hashes.begin(), hashes.end());
  EXPECT_EQ(std::adjacent_find(hashes.begin(), hashes.end()), hashes.end());
}

// Chunks c and c + 1 along an axis share two layers of voxels: 63 and 64 of the first are -1 and 0
// of the second.
TEST(Generate, NeighboursAgreeOnTheirSharedShell) {
  for (const IslandSpec& spec : one_of_each(70)) {
    const IslandGenerator generator(spec);
    for (int level = 0; level <= 4; ++level) {
      std::vector<BlockId> here(kPaddedCount), there(kPaddedCount);
      for (const IVec3 c : generator.chunks(level)) {
        generator.generate_padded(c, level, here);
        for (const IVec3 step : {IVec3{1, 0, 0}, IVec3{0, 1, 0}, IVec3{0, 0, 1}}) {
          generator.generate_padded({c.x + step.x, c.y + step.y, c.z + step.z}, level, there);
          std::size_t differ = 0;
          for (int a = -1; a <= 64; ++a) {
            for (int b = -1; b <= 64; ++b) {
              for (int k = 63; k <= 64; ++k) {
                const BlockId mine = step.x   ? padded_at(here, k, a, b)
                                     : step.y ? padded_at(here, a, k, b)
                                              : padded_at(here, a, b, k);
                const int o = k - 64;
                const BlockId other = step.x   ? padded_at(there, o, a, b)
                                      : step.y ? padded_at(there, a, o, b)
                                               : padded_at(there, a, b, o);
                // Plants of coarse levels are in their own chunk alone: they hide no neighbour's
                // face.
                const auto hiding = [level](BlockId id) {
                  return level > 0 && block_kind(id) == BlockKind::kPlant ? kAir : id;
                };
                differ += hiding(mine) != hiding(other);
              }
            }
          }
          ASSERT_EQ(differ, 0u) << "archetype " << spec.archetype << " level " << level;
        }
      }
    }
  }
}

TEST(Generate, ChunksOutsideTheListAreAir) {
  for (const IslandSpec& spec : one_of_each(60)) {
    const IslandGenerator generator(spec);
    std::vector<BlockId> voxels(kPaddedCount, block::kStone);
    for (int level = 0; level <= 4; ++level) {
      const auto listed = generator.chunks(level);
      EXPECT_TRUE(std::is_sorted(listed.begin(), listed.end(), [](const IVec3& a, const IVec3& b) {
        return std::array{a.y, a.x, a.z} < std::array{b.y, b.x, b.z};
      }));
      for (int y = -4; y <= 3; ++y) {
        for (int x = -3; x <= 2; ++x) {
          for (int z = -3; z <= 2; ++z) {
            if (std::find(listed.begin(), listed.end(), IVec3{x, y, z}) != listed.end()) continue;
            const bool any = generator.generate_padded({x, y, z}, level, voxels);
            const bool air =
                std::all_of(voxels.begin(), voxels.end(), [](BlockId id) { return id == kAir; });
            EXPECT_EQ(any, !air);
            std::size_t inner = 0;  // the shell may show a neighbour
            for (int i = 0; i < 64 * 64 * 64; ++i)
              inner += padded_at(voxels, i / 64 % 64, i / 4096, i % 64) != kAir;
            ASSERT_EQ(inner, 0u) << "archetype " << spec.archetype << " level " << level
                                 << " chunk " << x << ' ' << y << ' ' << z;
          }
        }
      }
    }
  }
}

TEST(Generate, VoxelsStayInTheBoxAndTheSphere) {
  std::vector<IslandSpec> specs = one_of_each(90);
  for (const IslandSpec& spec : one_of_each(24)) specs.push_back(spec);
  specs.push_back(spec_for(Archetype::kShard, Biome::kTropical, 12, 3));
  for (const IslandSpec& spec : specs) {
    const Voxels voxels(spec);
    EXPECT_EQ(voxels.outside, 0u) << "archetype " << spec.archetype;
    double farthest = 0.0;
    voxels.for_each([&](int x, int y, int z, BlockId id) {
      if (id == kAir) return;
      const auto far = [](int v) {
        return static_cast<double>(std::max(std::abs(v), std::abs(v + 1)));
      };
      farthest = std::max(farthest, far(x) * far(x) + far(y) * far(y) + far(z) * far(z));
    });
    EXPECT_GT(farthest, 0.0);
    EXPECT_LE(std::sqrt(farthest), spec.bounding_radius) << "archetype " << spec.archetype;
  }
}

TEST(Generate, NoWallOfWaterHangsInTheAir) {
  std::size_t water = 0;
  std::size_t bare = 0;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    for (const IslandSpec& spec : islands_within(seed, {}, 600.0)) {
      const Voxels voxels(spec);
      voxels.for_each([&](int x, int y, int z, BlockId id) {
        if (id != block::kWater) return;
        ++water;
        for (const BlockId next :
             {voxels.at(x + 1, y, z), voxels.at(x - 1, y, z), voxels.at(x, y, z + 1),
              voxels.at(x, y, z - 1), voxels.at(x, y - 1, z)}) {
          bare += next == kAir || block_kind(next) == BlockKind::kPlant;
        }
      });
    }
  }
  EXPECT_GT(water, 1000u);
  EXPECT_EQ(bare, 0u);
}

TEST(Generate, TreesStandOnTheGround) {
  for (const IslandSpec& spec : one_of_each(80)) {
    const Voxels voxels(spec);
    std::size_t hanging = 0;
    voxels.for_each([&](int x, int y, int z, BlockId id) {
      const bool log =
          (id >= block::kOakLog && id <= block::kWillowLog) || id == block::kMushroomStem;
      if (!log) return;
      // From any log, down and sideways through logs and leaves, ground must be in reach.
      bool carried = false;
      for (int dx = -1; dx <= 1 && !carried; ++dx) {
        for (int dz = -1; dz <= 1 && !carried; ++dz) {
          for (int dy = -1; dy <= 0 && !carried; ++dy)
            carried =
                (dx != 0 || dy != 0 || dz != 0) && is_solid(voxels.at(x + dx, y + dy, z + dz));
        }
      }
      hanging += !carried;
    });
    EXPECT_EQ(hanging, 0u) << "archetype " << spec.archetype;
  }
}

TEST(Generate, IslandsHoldWhatABiomePromises) {
  const auto counts = [](Archetype archetype, Biome biome) {
    std::vector<std::size_t> count(block::kBuiltInCount);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      Voxels(spec_for(archetype, biome, 90, seed)).for_each([&](int, int, int, BlockId id) {
        ++count[id];
      });
    }
    return count;
  };
  const auto meadow = counts(Archetype::kPlateau, Biome::kMeadow);
  for (const BlockId id : {block::kGrass, block::kDirt, block::kStone, block::kSand, block::kWater,
                           block::kOakLog, block::kBirchLog, block::kOakLeaves, block::kTallGrass,
                           block::kFlowerRed, block::kCoalOre, block::kIronOre, block::kGoldOre,
                           block::kCrystalBlue, block::kGlowShroom, block::kMycelium}) {
    EXPECT_GT(meadow[id], 0u) << block_types()[id].name;
  }
  const auto volcano = counts(Archetype::kVolcano, Biome::kVolcanic);
  for (const BlockId id : {block::kLava, block::kBasalt, block::kObsidian})
    EXPECT_GT(volcano[id], 100u) << block_types()[id].name;
  const auto highland = counts(Archetype::kRidge, Biome::kHighland);
  for (const BlockId id : {block::kSnow, block::kPineLog, block::kPineLeaves})
    EXPECT_GT(highland[id], 0u) << block_types()[id].name;
  const auto tropical = counts(Archetype::kCrescent, Biome::kTropical);
  for (const BlockId id : {block::kPalmLog, block::kSand, block::kWater})
    EXPECT_GT(tropical[id], 0u) << block_types()[id].name;
}

// A coarse voxel stands for 8^level blocks: the volume of rock and crowns must survive.
TEST(Generate, CoarseLevelsKeepTheVolume) {
  for (const IslandSpec& spec : one_of_each(100)) {
    const IslandGenerator generator(spec);
    std::vector<BlockId> voxels(kPaddedCount);
    double full = 0.0;
    for (int level = 0; level <= 3; ++level) {
      double volume = 0.0;
      for (const IVec3 c : generator.chunks(level)) {
        generator.generate_padded(c, level, voxels);
        for (int i = 0; i < 64 * 64 * 64; ++i)
          volume += is_solid(padded_at(voxels, i / 64 % 64, i / 4096, i % 64));
      }
      volume *= std::pow(8.0, level);
      if (level == 0) full = volume;
      EXPECT_NEAR(volume / full, 1.0, 0.08) << "archetype " << spec.archetype << " level " << level;
    }
  }
}

}  // namespace
}  // namespace skerry::world
