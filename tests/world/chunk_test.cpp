#include "world/voxel/chunk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace skerry::world {
namespace {

void expect_equal(const Chunk& chunk, const std::vector<BlockId>& truth) {
  std::vector<BlockId> unpacked(kChunkVoxels);
  chunk.unpack(unpacked);
  ASSERT_EQ(unpacked, truth);
  for (std::size_t i = 0; i < kChunkVoxels; i += 97) ASSERT_EQ(chunk.at(i), truth[i]) << i;
  const auto palette = chunk.palette();
  const std::set<BlockId> known(palette.begin(), palette.end());
  ASSERT_EQ(known.size(), palette.size());
  for (const BlockId id : std::set<BlockId>(truth.begin(), truth.end()))
    ASSERT_TRUE(known.contains(id)) << id;
}

TEST(Chunk, IndexOrderIsZThenXThenY) {
  EXPECT_EQ(voxel_index(0, 0, 1), 1u);
  EXPECT_EQ(voxel_index(1, 0, 0), 64u);
  EXPECT_EQ(voxel_index(0, 1, 0), 4096u);
  Chunk chunk;
  chunk.set(3, 5, 7, block::kStone);
  EXPECT_EQ(chunk.at(7 + 64 * 3 + 4096 * 5), block::kStone);
  EXPECT_EQ(chunk.at(3, 5, 7), block::kStone);
}

TEST(Chunk, UniformChunksTakeNoVoxelMemory) {
  Chunk chunk(block::kStone);
  chunk.set(1, 2, 3, block::kStone);
  EXPECT_TRUE(chunk.is_uniform());
  EXPECT_LT(chunk.size_bytes(), 128u);
  EXPECT_TRUE(Chunk::from_voxels(std::vector<BlockId>(kChunkVoxels, block::kDirt)).is_uniform());
}

// Storage for n ids: the smallest of 1, 2, 4, 8, 16 bits that holds n values; 64^3 / 8 = 32,768
// bytes a bit.
TEST(Chunk, StorageGrowsWithTheNumberOfIds) {
  for (const auto& [ids, bits] :
       {std::pair{2, 1}, {3, 2}, {4, 2}, {5, 4}, {16, 4}, {17, 8}, {256, 8}, {257, 16}}) {
    std::vector<BlockId> voxels(kChunkVoxels);
    for (std::size_t i = 0; i < kChunkVoxels; ++i)
      voxels[i] = static_cast<BlockId>(1000 + static_cast<int>(i) % ids);
    const Chunk chunk = Chunk::from_voxels(voxels);
    expect_equal(chunk, voxels);
    const std::size_t bytes = static_cast<std::size_t>(bits) * 32768;
    EXPECT_GE(chunk.size_bytes(), bytes) << ids;
    EXPECT_LT(chunk.size_bytes(), bytes + 1024) << ids;
  }
}

TEST(Chunk, RandomEditsMatchAPlainArray) {
  for (const int ids : {2, 4, 5, 16, 17, 250, 300, 65536}) {
    std::mt19937 rng(static_cast<unsigned>(ids));
    Chunk chunk(7);
    std::vector<BlockId> truth(kChunkVoxels, 7);
    for (int edit = 0; edit < 20000; ++edit) {
      const auto index = static_cast<std::size_t>(rng() % kChunkVoxels);
      const auto id = static_cast<BlockId>(rng() % static_cast<unsigned>(ids));
      chunk.set(static_cast<int>(index / 64 % 64), static_cast<int>(index / 4096),
                static_cast<int>(index % 64), id);
      truth[index] = id;
      ASSERT_EQ(chunk.at(index), id);
    }
    expect_equal(chunk, truth);
  }
}

TEST(Chunk, EditsAfterPackingMatchAPlainArray) {
  std::mt19937 rng(5);
  std::vector<BlockId> truth(kChunkVoxels);
  std::generate(truth.begin(), truth.end(), [&] { return static_cast<BlockId>(rng() % 400); });
  Chunk chunk = Chunk::from_voxels(truth);
  for (int edit = 0; edit < 5000; ++edit) {
    const auto index = static_cast<std::size_t>(rng() % kChunkVoxels);
    const auto id = static_cast<BlockId>(rng());
    chunk.set(static_cast<int>(index / 64 % 64), static_cast<int>(index / 4096),
              static_cast<int>(index % 64), id);
    truth[index] = id;
  }
  expect_equal(chunk, truth);
}

}  // namespace
}  // namespace skerry::world
