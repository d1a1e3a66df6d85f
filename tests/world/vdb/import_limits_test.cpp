// What a few bytes may ask for: each import ends soon, in bounded memory, with islands or a line.
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

#include "tests/world/vdb/imported.h"
#include "world/vdb_import/grid_choice.h"
#include "world/vdb_import/island_builder.h"

namespace skerry::world {
namespace {

VolumeGrid tile_grid(int tiles_a_side) {
  VolumeGrid grid;
  grid.kind = VolumeKind::kFog;
  grid.name = "density";
  grid.max_value = grid.mean_value = 1.0f;
  for (int x = 0; x < tiles_a_side; ++x)
    for (int y = 0; y < tiles_a_side; ++y)
      for (int z = 0; z < tiles_a_side; ++z)
        grid.tiles.push_back({{x * 4096, y * 4096, z * 4096}, 4096, 1.0f});
  return grid;
}

TEST(VdbImportLimits, RefusesAMillionMillionVoxelsAndTakesThemSmaller) {
  const VolumeGrid grid = tile_grid(3);  // 1.9e12 active voxels
  EXPECT_NE(refusal_of({grid}).find("--size"), std::string::npos);
  const std::vector<ImportedIsland> islands = imported({grid}, {.size_blocks = 512});
  ASSERT_EQ(islands.size(), 1u);
  std::uint64_t solid = 0, uniform = 0;
  for (const auto& [at, chunk] : islands[0].chunks) {
    uniform += chunk.is_uniform() ? 1 : 0;
    std::vector<BlockId> voxels(kChunkVoxels);
    chunk.unpack(voxels);
    for (const BlockId id : voxels) solid += is_solid(id) ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(solid), std::pow(512.0, 3.0), 8e5);
  EXPECT_GE(uniform, 6u * 6u * 6u);
}

TEST(VdbImportLimits, RefusesSlantedGridsThatNameTheSameChunksAgainAndAgain) {
  VolumeGrid grid;
  grid.kind = VolumeKind::kFog;
  // A slant of 1 in 300: the box around a brick's image is 300 times as long as the brick.
  grid.world_from_index = {
      {1.0, 0.0, 0.0, 0.0}, {300.0, 1.0, 0.0, 0.0}, {0.0, 300.0, 1.0, 0.0}, {0.0, 0.0, 0.0, 1.0}};
  for (int x = 0; x < 72; ++x)
    for (int y = 0; y < 72; ++y)
      for (int z = 0; z < 72; ++z) grid.tiles.push_back({{x * 8, y * 8, z * 8}, 8, 1.0f});
  grid.mean_value = grid.max_value = 1.0f;
  EXPECT_NE(refusal_of({grid}, {.scale = 0.1}).find("overlap"), std::string::npos);
}

/// Tiles between the centres of blocks, so that no block is solid, under the strongest slant that
/// the reader lets pass. Each looks as long as fourteen chunks.
VolumeGrid sheared_grid(int tiles) {
  VolumeGrid grid;
  grid.kind = VolumeKind::kMask;
  grid.world_from_index[1][0] = 900.0;
  for (int i = 0; i < tiles; ++i) grid.tiles.push_back({{0, 32 * i, 0}, 8, 1.0f});
  return grid;
}

/// Where a block is 32 of its voxels, and the first tile is between two centres of blocks.
Placement between_centres() {
  Placement out;
  glm::dmat3 linear(1.0 / 32.0);
  linear[1][0] = 900.0 / 32.0;
  out.lattice_from_index = {linear, {0.0, 0.1, 0.1}};
  out.index_from_lattice = out.lattice_from_index.inverse();
  return out;
}

TEST(VdbImportLimits, LooksOfChunksThatTurnOutEmptyCountToo) {
  const VolumeGrid grid = sheared_grid(64);
  const SolidRule rule{false, 0.5f, true};
  const VolumeField field(grid);
  const Placement placement = between_centres();
  Jobs jobs(2);
  ImportCost cost;
  const Result<std::set<IVec3>> chunks = chunks_of(grid, rule, placement, cost);
  ASSERT_TRUE(chunks);
  EXPECT_EQ(cost.chunks, chunks->size());
  const auto masks = solid_masks(field, rule, placement, *chunks, {cost, jobs, {}});
  ASSERT_TRUE(masks) << masks.error().message;
  EXPECT_TRUE(masks->empty());
  EXPECT_EQ(cost.mixed_chunks, 0u);
  EXPECT_GT(cost.looks, chunks->size() * kChunkVoxels / 8);

  const std::uint64_t looks = cost.looks;
  cost.looks = kMaxImportLooks - looks + 1;
  const auto refused = solid_masks(field, rule, placement, *chunks, {cost, jobs, {}});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("slanted"), std::string::npos);
}

TEST(VdbImportLimits, EveryGridOfAFileDrawsOnTheSameLimits) {
  // Each tile has a part in eight chunks, none of which it fills. One such grid is fine; ever so
  // many of a small file would be work without end.
  VolumeGrid grid;
  grid.kind = VolumeKind::kIds;
  for (int i = 0; i < 400; ++i) grid.tiles.push_back({{128 * i, 0, 0}, 8, 7.0f});
  const std::vector<ImportedIsland> one = imported({grid});
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].chunks.size(), 3200u);
  EXPECT_NE(refusal_of({grid, grid, grid}).find("8192 chunks"), std::string::npos);
}

TEST(VdbImportLimits, ManyBlocksOfOneIdUnderASlantAreCounted) {
  VolumeGrid grid;
  grid.kind = VolumeKind::kIds;
  grid.world_from_index[1][0] = 300.0;
  grid.tiles = {{{0, 0, 0}, 512, 5.0f}, {{0, 4096, 0}, 512, 6.0f}};
  const ImportOptions options{.scale = 1.0};
  const IslandSource source(grid, options);
  Jobs jobs(2);
  ImportCost cost;
  const auto island = IslandBuilder(source, options, 1.0, cost, jobs).run(nullptr, 1, {});
  const std::uint64_t without_limit = cost.looks;
  ImportCost nearly_spent;
  nearly_spent.looks = kMaxImportLooks - without_limit / 2;
  const auto refused = IslandBuilder(source, options, 1.0, nearly_spent, jobs).run(nullptr, 1, {});
  ASSERT_FALSE(refused);
}

}  // namespace
}  // namespace skerry::world
