#include "world/mesh/occupancy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "engine/core/jobs.h"
#include "shaders/shared/occupancy.h"
#include "world/mesh/mesh.h"
#include "world/stream/stream.h"
#include "world/voxel/chunk.h"

namespace skerry::world {
namespace {

std::size_t padded_index(int x, int y, int z) {
  return static_cast<std::size_t>((z + 1) + kPaddedEdge * (x + 1) +
                                  kPaddedEdge * kPaddedEdge * (y + 1));
}

/// What the GPU would find at a voxel, read as shaders/shared/occupancy.h describes the layout.
bool opaque_at(const ChunkOccupancy& chunk, int x, int y, int z) {
  if (chunk.fill != ChunkOccupancy::Fill::kMixed) return chunk.fill == ChunkOccupancy::Fill::kFull;
  const std::uint32_t entry =
      chunk.table[static_cast<std::size_t>(z / 8 + 8 * (x / 8) + 64 * (y / 8))];
  if (entry == shared::kBrickEmpty || entry == shared::kBrickFull)
    return entry == shared::kBrickFull;
  const int word = z % 8 / 4 + 2 * (x % 8 / 4) + 4 * (y % 8 / 2);
  const int bit = z % 4 + 4 * (x % 4) + 16 * (y % 2);
  return (chunk.words.at((entry & 0xffffffu) * 16 + static_cast<std::size_t>(word)) >> bit & 1u) !=
         0;
}

void expect_equals(const ChunkOccupancy& chunk, const std::vector<BlockId>& voxels) {
  int wrong = 0;
  for (int y = 0; y < kChunkEdge; ++y)
    for (int x = 0; x < kChunkEdge; ++x)
      for (int z = 0; z < kChunkEdge; ++z)
        wrong += opaque_at(chunk, x, y, z) !=
                 (block_kind(voxels[padded_index(x, y, z)]) == BlockKind::kOpaque);
  EXPECT_EQ(wrong, 0);
}

/// Every octant that has an opaque voxel has its bit, and no other has.
void expect_octants(const ChunkOccupancy& chunk) {
  for (int y = 0; y < kChunkEdge; y += 4)
    for (int x = 0; x < kChunkEdge; x += 4)
      for (int z = 0; z < kChunkEdge; z += 4) {
        bool any = false;
        for (int i = 0; i < 64; ++i)
          any = any || opaque_at(chunk, x + i % 4, y + i / 16, z + i / 4 % 4);
        const std::uint32_t entry =
            chunk.table[static_cast<std::size_t>(z / 8 + 8 * (x / 8) + 64 * (y / 8))];
        const int octant = z / 4 % 2 + 2 * (x / 4 % 2) + 4 * (y / 4 % 2);
        ASSERT_EQ(entry >> (24 + octant) & 1u, any ? 1u : 0u) << x << ' ' << y << ' ' << z;
      }
}

TEST(OccupancyOfChunks, HoldsTheOpaqueVoxelsOfRandomChunksAndNoOthers) {
  constexpr BlockId kKinds[] = {block::kStone,     block::kDirt,  kAir,          kAir,
                                block::kOakLeaves, block::kWater, block::kGlass, block::kTallGrass};
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    std::mt19937 random(seed);
    std::vector<BlockId> voxels(kPaddedVoxels);
    // Boxes of one block each, so that some bricks are empty, some full and some mixed.
    for (int box = 0; box < (seed == 0 ? 0 : 60); ++box) {
      const BlockId id = kKinds[random() % 8];
      int low[3], high[3];
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = static_cast<int>(random() % 66) - 1;
        high[axis] = std::min(65, low[axis] + static_cast<int>(random() % 30));
      }
      for (int y = low[1]; y < high[1]; ++y)
        for (int x = low[0]; x < high[0]; ++x)
          for (int z = low[2]; z < high[2]; ++z) voxels[padded_index(x, y, z)] = id;
    }
    for (int i = 0; i < 4000; ++i) voxels[random() % kPaddedVoxels] = kKinds[random() % 8];
    const ChunkOccupancy chunk = occupancy_of(voxels);
    expect_equals(chunk, voxels);
    ASSERT_EQ(chunk.fill, ChunkOccupancy::Fill::kMixed);
    ASSERT_EQ(chunk.table.size(), shared::kBricksPerChunk);
    expect_octants(chunk);
  }
}

TEST(OccupancyOfChunks, UniformChunksAndBricksStoreNothing) {
  std::vector<BlockId> voxels(kPaddedVoxels, block::kWater);
  ChunkOccupancy chunk = occupancy_of(voxels);
  EXPECT_EQ(chunk.fill, ChunkOccupancy::Fill::kEmpty);
  EXPECT_TRUE(chunk.table.empty() && chunk.words.empty());
  // The shell belongs to the neighbours.
  voxels[padded_index(-1, 5, 5)] = block::kStone;
  EXPECT_EQ(occupancy_of(voxels).fill, ChunkOccupancy::Fill::kEmpty);

  std::ranges::fill(voxels, block::kStone);
  chunk = occupancy_of(voxels);
  EXPECT_EQ(chunk.fill, ChunkOccupancy::Fill::kFull);
  EXPECT_TRUE(chunk.table.empty() && chunk.words.empty());

  // One hole: one brick is stored, the others are full.
  voxels[padded_index(63, 0, 8)] = kAir;
  chunk = occupancy_of(voxels);
  EXPECT_EQ(chunk.words.size(), shared::kBrickWords);
  EXPECT_EQ(std::ranges::count(chunk.table, shared::kBrickFull), 511);
  expect_equals(chunk, voxels);
}

// --- Streamed along with the meshes

struct Home {
  World world{WorldDesc{.seed = 1, .island_limit = 1}};
  Jobs jobs{2};
  std::uint64_t id = world.islands_near(world.origin(), 1000.0, 0.0).front().id;
  StreamView view;
  StreamSettings settings{.view_distance_blocks = 320.0, .detail_distance_blocks = 320.0};
  Home() { view.camera = moved(world.origin(), {0.0, 60.0, 0.0}); }
  StreamUpdate all(Streamer& streamer) {
    streamer.update(view, settings);
    streamer.wait_until_complete();
    return streamer.poll(~std::size_t{0});
  }
};

TEST(OccupancyOfChunks, StreamsWithEveryChunkEvenIfNothingOfItIsSeen) {
  Home home;
  // A solid chunk in solid surroundings: it has no face.
  constexpr IVec3 kBuried{0, 10, 0};
  std::map<IVec3, ChunkEdits> stone;  // chunk by chunk: one by one takes the square of the time
  for (int y = 639; y < 705; ++y)
    for (int x = -1; x < 65; ++x)
      for (int z = -1; z < 65; ++z)
        stone[chunk_of({x, y, z})].push_back(
            {static_cast<std::uint32_t>(voxel_index(x & 63, y & 63, z & 63)), block::kStone});
  for (auto& [chunk, edits] : stone) {
    std::ranges::sort(edits, {}, &VoxelEdit::index);
    ASSERT_TRUE(home.world.set_blocks(home.id, chunk, edits));
  }
  Streamer streamer(home.world, home.jobs, StreamOf::kMeshesAndOccupancy);
  std::map<IVec3, ReadySection> ready;
  for (ReadySection& section : home.all(streamer).ready)
    ready.emplace(section.key.chunk, std::move(section));
  std::vector<BlockId> voxels(kPaddedVoxels);
  for (const IVec3& chunk : home.world.chunks(home.id, 0)) {
    (void)home.world.generate_padded(home.id, chunk, 0, voxels);
    const bool any = occupancy_of(voxels).fill != ChunkOccupancy::Fill::kEmpty;
    const auto found = ready.find(chunk);
    ASSERT_TRUE(found != ready.end() || !any);
    if (found != ready.end()) expect_equals(found->second.occupancy, voxels);
  }
  ASSERT_TRUE(ready.contains(kBuried));
  EXPECT_TRUE(ready.at(kBuried).mesh.quads.empty());
  EXPECT_EQ(ready.at(kBuried).occupancy.fill, ChunkOccupancy::Fill::kFull);
}

TEST(OccupancyOfChunks, FollowsEdits) {
  Home home;
  Streamer streamer(home.world, home.jobs, StreamOf::kMeshesAndOccupancy);
  (void)home.all(streamer);
  ASSERT_TRUE(home.world.set_block(home.id, {5, 640, 5}, block::kLamp));
  StreamUpdate update = home.all(streamer);
  ASSERT_EQ(update.ready.size(), 1u);
  EXPECT_TRUE(opaque_at(update.ready[0].occupancy, 5, 0, 5));
  EXPECT_FALSE(opaque_at(update.ready[0].occupancy, 5, 1, 5));
  ASSERT_TRUE(home.world.set_block(home.id, {5, 640, 5}, kAir));
  update = home.all(streamer);
  EXPECT_EQ(update.removed.size(), 1u);
  EXPECT_TRUE(update.ready.empty());
}

TEST(OccupancyOfChunks, IsNotMadeUnlessAskedFor) {
  Home home;
  Streamer streamer(home.world, home.jobs);
  for (const ReadySection& section : home.all(streamer).ready) {
    EXPECT_EQ(section.occupancy.fill, ChunkOccupancy::Fill::kEmpty);
    EXPECT_FALSE(section.mesh.quads.empty());
  }
}

}  // namespace
}  // namespace skerry::world
