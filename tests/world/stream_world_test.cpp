#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "world/generate/generate.h"
#include "world/islands/world.h"
#include "world/mesh/mesh.h"

namespace skerry::world {
namespace {

constexpr double kFar = 2500.0;

std::vector<std::uint64_t> ids_of(const std::vector<IslandSpec>& specs) {
  std::vector<std::uint64_t> ids;
  for (const IslandSpec& spec : specs) ids.push_back(spec.id);
  return ids;
}

IslandSpec home_of(World& world) {
  return world.islands_near(world.origin(), 1000.0, 0.0).front();
}

/// Some level-0 voxel of the island that is not air.
IVec3 some_block(World& world, const IslandSpec& spec) {
  for (IVec3 voxel{3, spec.box_max.y, 5}; voxel.y >= spec.box_min.y; --voxel.y) {
    world.ensure_chunk(spec.id, chunk_of(voxel));
    if (world.block_at(spec.id, voxel).value() != kAir) return voxel;
  }
  ADD_FAILURE() << "the home island has no block in the middle";
  return {};
}

TEST(World, NoIslandDriftsFurtherThanTheMargin) {
  for (const std::uint64_t seed : {0u, 1u, 77u}) {
    for (const IslandSpec& spec : islands_within(seed, {}, 6000.0)) {
      EXPECT_LE(length(spec.drift_amplitude), kMaxIslandDriftBlocks);
    }
  }
}

TEST(World, IslandsNearFollowsTheDrift) {
  const World world({.seed = 9});
  for (const double time_s : {0.0, 1e3, 7.7e6}) {
    const std::vector<IslandSpec> near = world.islands_near({}, 700.0, time_s);
    std::set<std::uint64_t> expected;
    double last = 0.0;
    for (const IslandSpec& spec : islands_within(9, {}, kFar)) {
      const double distance = length(difference_blocks(pose_at(spec, time_s).origin, {}));
      if (distance - spec.bounding_radius <= 700.0) expected.insert(spec.id);
    }
    for (const IslandSpec& spec : near) {
      const double distance = length(difference_blocks(pose_at(spec, time_s).origin, {}));
      EXPECT_GE(distance, last);
      last = distance;
      EXPECT_EQ(expected.erase(spec.id), 1u);
    }
    EXPECT_TRUE(expected.empty());
  }
}

TEST(World, AnOffsetMovesIslandsAndSpawnExactly) {
  const std::array<std::int64_t, 3> offset{std::int64_t{1} << 40, -7, -(std::int64_t{1} << 40)};
  const World here({.seed = 5}), there({.seed = 5, .offset_blocks = offset});
  const auto a = here.islands_near(here.origin(), kFar, 3.0);
  const auto b = there.islands_near(there.origin(), kFar, 3.0);
  ASSERT_EQ(ids_of(a), ids_of(b));
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(b[i].origin - there.origin(), a[i].origin);
    EXPECT_EQ(there.pose(b[i].id, 3.0)->origin - there.origin(), here.pose(a[i].id, 3.0)->origin);
  }
  EXPECT_EQ(there.spawn().feet - there.origin(), here.spawn().feet);
}

TEST(World, ALimitKeepsTheIslandsNearestToTheWorldsOrigin) {
  const std::vector<std::uint64_t> all = ids_of(islands_within(2, {}, 20000.0));
  for (const std::uint32_t limit : {0u, 1u, 5u, 60u}) {
    const World world({.seed = 2, .offset_blocks = {1000000, 0, 0}, .island_limit = limit});
    std::vector<std::uint64_t> ids = ids_of(world.islands_near(world.origin(), 20000.0, 0.0));
    std::vector<std::uint64_t> expected(all.begin(), all.begin() + limit);
    std::sort(ids.begin(), ids.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(ids, expected) << limit;
  }
}

TEST(World, UnknownIslandsAnswerWithNothing) {
  World world({.seed = 1});
  EXPECT_FALSE(world.island(12345));
  EXPECT_FALSE(world.pose(12345, 0.0));
  EXPECT_FALSE(world.block_at(12345, {}));
  EXPECT_FALSE(world.ensure_chunk(12345, {}));
  EXPECT_FALSE(world.set_block(12345, {}, block::kStone));
  EXPECT_TRUE(world.chunks(12345, 0).empty());
  EXPECT_TRUE(world.take_edits().empty());
}

TEST(World, BlocksAreWhatTheGeneratorMakes) {
  World world({.seed = 4});
  const IslandSpec home = home_of(world);
  const IslandGenerator generator(home);
  const IVec3 chunk{-1, -1, 0};
  EXPECT_FALSE(world.block_at(home.id, {-5, -5, 5}));  // in the box, not loaded
  ASSERT_TRUE(world.ensure_chunk(home.id, chunk));
  std::vector<BlockId> padded(kPaddedVoxels);
  generator.generate_padded(chunk, 0, padded);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      for (int z = 0; z < 64; ++z) {
        const auto at = static_cast<std::size_t>(z + 1 + 66 * (x + 1 + 66 * (y + 1)));
        ASSERT_EQ(world.block_at(home.id, {x - 64, y - 64, z}), padded[at]);
      }
    }
  }
  EXPECT_EQ(world.usage().chunks, 1u);
  world.release_voxels(home.id);
  EXPECT_EQ(world.usage().chunks, 0u);
}

TEST(World, OutsideTheBoxAndTheListedChunksIsAir) {
  World world({.seed = 4});
  const IslandSpec home = home_of(world);
  EXPECT_EQ(world.block_at(home.id, {home.box_max.x, 0, 0}), kAir);
  const std::vector<IVec3> list = world.chunks(home.id, 0);
  const std::set<IVec3> listed(list.begin(), list.end());
  for (IVec3 v = home.box_min; v.y < home.box_max.y; ++v.y) {
    EXPECT_EQ(world.block_at(home.id, v).has_value(), !listed.contains(chunk_of(v)));
  }
}

TEST(World, EditsOutliveTheirChunk) {
  World world({.seed = 4});
  const IslandSpec home = home_of(world);
  const IVec3 voxel = some_block(world, home);
  ASSERT_TRUE(world.set_block(home.id, voxel, block::kLamp));
  EXPECT_EQ(world.block_at(home.id, voxel), block::kLamp);
  world.release_voxels(home.id);
  EXPECT_EQ(world.block_at(home.id, voxel), block::kLamp);  // known though not loaded
  ASSERT_TRUE(world.ensure_chunk(home.id, chunk_of(voxel)));
  EXPECT_EQ(world.block_at(home.id, voxel), block::kLamp);
  const std::vector<EditedBox> edits = world.take_edits();
  ASSERT_EQ(edits.size(), 1u);
  EXPECT_EQ(edits[0].min, voxel);
  EXPECT_EQ(edits[0].max, voxel);
  EXPECT_TRUE(world.take_edits().empty());
}

TEST(World, AChunkMadeBeforeAnEditIsKeptWithIt) {
  World world({.seed = 4});
  const IslandSpec home = home_of(world);
  const Chunk made_before(block::kStone);
  ASSERT_TRUE(world.set_block(home.id, {-1, 2, 3}, block::kLamp));
  world.keep_chunk(home.id, {-1, 0, 0}, made_before);
  EXPECT_EQ(world.block_at(home.id, {-1, 2, 3}), block::kLamp);
  EXPECT_EQ(world.block_at(home.id, {-2, 2, 3}), block::kStone);
}

TEST(World, EditsShowInShells) {
  World world({.seed = 4});
  const IslandSpec home = home_of(world);
  const IVec3 high{64, 1025, 2};  // in air; the lowest x layer of chunk (1, 16, 0)
  ASSERT_TRUE(world.set_block(home.id, high, block::kLamp));
  std::vector<BlockId> padded(kPaddedVoxels);
  const auto at = [&](int x, int y, int z) {
    return padded[static_cast<std::size_t>(z + 1 + 66 * (x + 1 + 66 * (y + 1)))];
  };
  EXPECT_TRUE(world.generate_padded(home.id, {1, 16, 0}, 0, padded));
  EXPECT_EQ(at(0, 1, 2), block::kLamp);
  EXPECT_TRUE(world.generate_padded(home.id, {0, 16, 0}, 0, padded));
  EXPECT_EQ(at(64, 1, 2), block::kLamp);
  const std::vector<IVec3> fine = world.chunks(home.id, 0), coarse = world.chunks(home.id, 1);
  EXPECT_EQ(std::count(fine.begin(), fine.end(), IVec3{1, 16, 0}), 1);
  EXPECT_EQ(std::count(coarse.begin(), coarse.end(), IVec3{0, 8, 0}), 1);
}

// What is built fills the coarse voxels that it is half of, at any level.
TEST(World, CoarseVoxelsAreWhatHalfOfTheirBlocksBecome) {
  World world({.seed = 4});
  const IslandSpec home = home_of(world);
  std::vector<BlockId> padded(kPaddedVoxels);
  const auto first = [&](int level) {  // the voxel whose lowest block is (0, 1024, 0)
    world.generate_padded(home.id, {0, 1024 / (64 << level), 0}, level, padded);
    return padded[1 + 66 * (1 + 66)];
  };
  for (int level = 1; level < kLevelCount; ++level) {
    const int edge = 1 << level;
    std::vector<IVec3> lower_half;
    for (int i = 0; i < edge * edge * edge / 2; ++i)
      lower_half.push_back({i / edge % edge, 1024 + i / (edge * edge), i % edge});
    for (const IVec3& v : lower_half) {
      if (v == lower_half.back()) {
        EXPECT_EQ(first(level), kAir) << "less than half of it";
      }
      ASSERT_TRUE(world.set_block(home.id, v, block::kPlanks));
    }
    EXPECT_EQ(first(level), block::kPlanks) << "level " << level;
    EXPECT_EQ(world.chunks(home.id, level).back(), (IVec3{0, 1024 / (64 << level), 0}));
  }
}

TEST(World, AHoleShowsAtCoarseLevels) {
  World world({.seed = 4});
  const IslandSpec home = home_of(world);
  const IVec3 inner = chunk_of(some_block(world, home));
  std::vector<BlockId> before(kPaddedVoxels), after(kPaddedVoxels);
  const IVec3 chunk{inner.x >> 1, inner.y >> 1, inner.z >> 1};
  ASSERT_TRUE(world.generate_padded(home.id, chunk, 1, before));
  std::vector<VoxelEdit> all;
  for (std::uint32_t i = 0; i < kChunkVoxels; ++i) all.push_back({i, kAir});
  ASSERT_TRUE(world.set_blocks(home.id, inner, all));
  world.generate_padded(home.id, chunk, 1, after);
  std::size_t gone = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      for (int z = 0; z < 64; ++z) {
        const auto i = static_cast<std::size_t>(z + 1 + 66 * (x + 1 + 66 * (y + 1)));
        const bool dug =
            x / 32 == (inner.x & 1) && y / 32 == (inner.y & 1) && z / 32 == (inner.z & 1);
        ASSERT_EQ(after[i], dug ? BlockId{kAir} : before[i]);
        gone += dug && before[i] != kAir;
      }
  EXPECT_GT(gone, 100u);
}

// Lamps are lone blocks; of many some are shown, so that their faces have the same area.
TEST(World, LampsOfTheFarShine) {
  World world({.seed = 4});
  const IslandSpec home = home_of(world);
  std::vector<VoxelEdit> lamps;
  for (int y = 0; y < 64; y += 4)
    for (int x = 0; x < 64; x += 4)
      for (int z = 0; z < 64; z += 4)
        lamps.push_back({static_cast<std::uint32_t>(voxel_index(x, y, z)), block::kLamp});
  ASSERT_TRUE(world.set_blocks(home.id, {0, 16, 0}, lamps));
  std::vector<BlockId> padded(kPaddedVoxels);
  for (int level = 1; level <= 2; ++level) {
    world.generate_padded(home.id, {0, 1024 / (64 << level), 0}, level, padded);
    const auto shown = std::count(padded.begin(), padded.end(), BlockId{block::kLamp});
    const double faces = 5.0 * std::pow(4.0, level) * static_cast<double>(shown);
    EXPECT_NEAR(faces / (4.0 * static_cast<double>(lamps.size())), 1.0, 0.15) << "level " << level;
  }
}

TEST(World, NegativeVoxelsFallIntoNegativeChunks) {
  EXPECT_EQ(chunk_of({-1, 0, 63}), (IVec3{-1, 0, 0}));
  EXPECT_EQ(chunk_of({-64, -65, 64}), (IVec3{-1, -2, 1}));
  EXPECT_EQ(index_in_chunk({-1, -64, 65}), voxel_index(63, 0, 1));
}

}  // namespace
}  // namespace skerry::world
