#include "world/islands/stored_voxels.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "world/islands/world.h"
#include "world/mesh/mesh.h"
#include "world/voxel/edits.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

using Voxels = std::map<IVec3, BlockId>;

IslandSpec spec_of(std::uint64_t id, WorldPos origin = {}) {
  IslandSpec spec;
  spec.id = id;
  spec.origin = origin;
  return spec;
}

std::map<IVec3, Chunk> chunks_of(const Voxels& voxels) {
  std::map<IVec3, Chunk> chunks;
  for (const auto& [v, id] : voxels) {
    const IVec3 in = place_in_chunk(static_cast<std::uint32_t>(index_in_chunk(v)));
    chunks.try_emplace(chunk_of(v), Chunk(kAir)).first->second.set(in.x, in.y, in.z, id);
  }
  return chunks;
}

BlockId at(const Voxels& voxels, IVec3 v) {
  const auto found = voxels.find(v);
  return found == voxels.end() ? kAir : found->second;
}

/// A blob about the corner where eight chunks meet.
Voxels blob(std::uint64_t seed, int reach, int count) {
  Rng rng(seed);
  Voxels voxels;
  for (int i = 0; i < count; ++i)
    voxels[{rng.in(-reach, reach - 1), rng.in(-reach, reach - 1), rng.in(-reach, reach - 1)}] =
        static_cast<BlockId>(rng.in(1, 5));
  return voxels;
}

TEST(StoredVoxels, PaddedChunksShowTheirNeighbours) {
  const Voxels voxels = blob(1, 70, 60'000);
  const StoredVoxels stored(chunks_of(voxels));
  std::vector<BlockId> out(kPaddedVoxels);
  EXPECT_EQ(stored.chunks(0).size(), 64u);
  for (const IVec3& chunk : stored.chunks(0)) {
    ASSERT_TRUE(stored.generate_padded(chunk, 0, out));
    for (int y = -1; y <= kChunkEdge; ++y)
      for (int x = -1; x <= kChunkEdge; ++x)
        for (int z = -1; z <= kChunkEdge; ++z)
          ASSERT_EQ(out[static_cast<std::size_t>(z + 1 + 66 * (x + 1 + 66 * (y + 1)))],
                    at(voxels, {chunk.x * 64 + x, chunk.y * 64 + y, chunk.z * 64 + z}));
  }
  EXPECT_FALSE(stored.generate_padded({9, 9, 9}, 0, out));
  EXPECT_EQ(out[0], kAir);
}

TEST(StoredVoxels, ACoarseVoxelIsThereWhenHalfOfItIs) {
  for (int filled = 0; filled <= 8; ++filled) {
    Voxels voxels{{{40, 40, 40}, block::kStone}};  // keeps the chunk
    for (int i = 0; i < filled; ++i)
      voxels[{-2 + i % 2, -2 + i / 4, -2 + i / 2 % 2}] = i < 4 ? block::kStone : block::kGrass;
    const StoredVoxels stored(chunks_of(voxels));
    std::vector<BlockId> out(kPaddedVoxels);
    stored.generate_padded({-1, -1, -1}, 1, out);
    const BlockId shown = out[static_cast<std::size_t>(64 + 66 * (64 + 66 * 64))];
    const BlockId expected[]{block::kGrass, block::kStone, kAir};
    EXPECT_EQ(shown, expected[filled < 4 ? 2 : filled == 4 ? 1 : 0]) << filled;
  }
}

TEST(StoredVoxels, ASolidCubeStaysItselfAtEveryLevel) {
  Voxels voxels;
  for (int y = -32; y < 32; ++y)
    for (int x = -32; x < 32; ++x)
      for (int z = -32; z < 32; ++z) voxels[{x, y, z}] = block::kMarble;
  const StoredVoxels stored(chunks_of(voxels));
  std::vector<BlockId> out(kPaddedVoxels);
  for (int level = 0; level < kLevelCount; ++level) {
    std::size_t count = 0;
    for (const IVec3& chunk : stored.chunks(level)) {
      stored.generate_padded(chunk, level, out);
      const Chunk inner = chunk_from_padded(out);
      for (std::size_t i = 0; i < kChunkVoxels; ++i) count += inner.at(i) == block::kMarble;
    }
    EXPECT_EQ(count, std::size_t{64 * 64 * 64} >> 3 * level) << level;
  }
}

TEST(StoredVoxels, ASpecIsFittedTightly) {
  const StoredVoxels stored(
      chunks_of({{{-3, 70, 1}, block::kStone}, {{5, -66, 2}, block::kStone}}));
  const IslandSpec spec = fitted(spec_of(4), stored);
  EXPECT_EQ(spec.box_min, (IVec3{-3, -66, 1}));
  EXPECT_EQ(spec.box_max, (IVec3{6, 71, 3}));
  EXPECT_DOUBLE_EQ(spec.bounding_radius, std::sqrt(36.0 + 71.0 * 71.0 + 9.0));
}

TEST(AddedIslands, AreFoundEditedAndSpawnedOn) {
  WorldDesc desc;
  desc.generated = false;
  World world(desc);
  EXPECT_TRUE(world.islands_near({}, 1000.0, 0.0).empty());
  Voxels voxels;
  for (int x = 0; x < 9; ++x)
    for (int z = 0; z < 9; ++z) voxels[{x, 3, z}] = block::kStone;
  const auto stored = std::make_shared<const StoredVoxels>(chunks_of(voxels));
  const std::uint64_t id = world.unused_id(), revision = world.revision();
  ASSERT_TRUE(world.add_island(fitted(spec_of(id, {65536, 0, 0}), *stored), stored));
  EXPECT_FALSE(world.add_island(fitted(spec_of(id), *stored), stored));
  EXPECT_NE(world.unused_id(), id);
  EXPECT_GT(world.revision(), revision);
  ASSERT_EQ(world.islands_near({}, 10.0, 0.0).size(), 1u);
  EXPECT_TRUE(world.islands_near({100 * 65536, 0, 0}, 10.0, 0.0).empty());
  EXPECT_EQ(world.spawn().island, id);
  EXPECT_EQ(world.spawn().feet, moved({65536, 0, 0}, {4.5, 4.0, 4.5}));
  // Building beyond the box widens it; otherwise what is there would not be looked for.
  ASSERT_TRUE(world.set_block(id, {4, 90, 4}, block::kLamp));
  EXPECT_EQ(world.island(id)->box_max.y, 91);
  EXPECT_GE(world.island(id)->bounding_radius, 91.0);
  EXPECT_EQ(world.chunks(id, 0).size(), 2u);
  EXPECT_EQ(world.islands_near({}, 10.0, 0.0).at(0).box_max.y, 91);
  world.release_voxels(id);
  world.release_plan(id);
  EXPECT_EQ(world.chunk_now(id, {0, 0, 0}).at(4, 3, 4), block::kStone);
}

TEST(GrownIslands, AreFoundByWhatWasBuiltOnThem) {
  World world({.seed = 4});
  const IslandSpec spec = world.islands_near({}, 300.0, 0.0).front();
  const IVec3 spire{0, spec.box_max.y + 500, 0};
  ASSERT_TRUE(world.set_block(spec.id, spire, block::kStone));
  const WorldPos above = moved(world.pose(spec.id, 0.0)->origin, {0.0, double(spire.y), 0.0});
  const std::vector<IslandSpec> near = world.islands_near(above, 20.0, 0.0);
  ASSERT_EQ(near.size(), 1u);
  EXPECT_EQ(near.front().id, spec.id);
  EXPECT_EQ(near.front().box_max.y, spire.y + 1);
}

TEST(MovedIslands, AreWhereTheyWerePut) {
  World world({.seed = 4});
  const std::vector<IslandSpec> near = world.islands_near({}, 300.0, 0.0);
  const IslandSpec spec = near.front();
  const Pose far{moved(spec.origin, {5000.0, 0.0, 0.0}), glm::dquat{0.6, 0.0, 0.8, 0.0}};
  const Pose farther{moved(far.origin, {1.0, 0.0, 0.0}), far.rotation};
  ASSERT_TRUE(world.move_island(spec.id, 600, far));
  ASSERT_TRUE(world.move_island(spec.id, 601, farther));
  EXPECT_FALSE(world.move_island(12345, 600, far));
  EXPECT_EQ(world.pose(spec.id, 10.0)->origin, far.origin);
  EXPECT_EQ(world.pose(spec.id, 10.5 / 60.0 + 9.0)->origin, far.origin);
  EXPECT_EQ(world.pose(spec.id, 600.5 / 60.0)->origin, moved(far.origin, {0.5, 0.0, 0.0}));
  EXPECT_EQ(world.pose(spec.id, 99.0)->origin, farther.origin);
  const auto listed = [&](WorldPos centre) {
    int count = 0;
    for (const IslandSpec& s : world.islands_near(centre, 10.0, 10.0)) count += s.id == spec.id;
    return count;
  };
  EXPECT_EQ(listed(spec.origin), 0);
  EXPECT_EQ(listed(far.origin), 1);
}

TEST(World, BuildingPastAnIslandsEdgeLeavesTheRestOfItAsItWas) {
  WorldDesc desc;
  desc.seed = 4;
  World world(desc), kept(desc);
  const std::vector<IslandSpec> near = world.islands_near({}, 600.0, 0.0);
  kept.islands_near({}, 600.0, 0.0);
  const IslandSpec home =
      *std::min_element(near.begin(), near.end(), [](const IslandSpec& a, const IslandSpec& b) {
        return a.bounding_radius < b.bounding_radius;
      });
  kept.chunks(home.id, 0);  // its plan is made before anything is built
  for (World* w : {&world, &kept}) {
    w->set_block(home.id, {home.box_max.x + 5, 0, 0}, block::kStone);
    w->set_block(home.id, {20'000, 0, 0}, block::kStone);
  }
  EXPECT_EQ(world.island(home.id)->box_max.x, 20'001);
  world.release_plan(home.id);
  const std::vector<IVec3> chunks = kept.chunks(home.id, 0);
  ASSERT_EQ(world.chunks(home.id, 0), chunks);
  std::vector<BlockId> before(kPaddedVoxels), after(kPaddedVoxels);
  for (const IVec3& at : chunks) {
    kept.generate_padded(home.id, at, 0, before);
    world.generate_padded(home.id, at, 0, after);
    ASSERT_EQ(before, after);
  }
}

}  // namespace
}  // namespace skerry::world
