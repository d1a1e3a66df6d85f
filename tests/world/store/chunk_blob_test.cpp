#include "world/store/chunk_blob.h"

#include <gtest/gtest.h>

#include "tests/world/store/made_worlds.h"

namespace skerry::world {
namespace {

constexpr ChunkName kName{0xfedc'ba98'7654'3210, {-3, 4, 5}};

TEST(ChunkBlob, EditsAndChunksComeBackAsTheyWere) {
  Rng rng(1);
  for (int round = 0; round < 40; ++round) {
    const ChunkEdits edits = random_edits(rng, 2000);
    const auto back = decode_edits(kName, encode_edits(kName, edits));
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, edits);
    const Chunk chunk = random_chunk(rng);
    const auto whole = decode_chunk(kName, encode_chunk(kName, chunk));
    ASSERT_TRUE(whole);
    EXPECT_EQ(blocks_of(*whole), blocks_of(chunk));
  }
}

TEST(ChunkBlob, AllVoxelsOfAChunkMayBeEdited) {
  ChunkEdits edits(kChunkVoxels);
  for (std::uint32_t i = 0; i < kChunkVoxels; ++i) edits[i] = {i, kAir};
  const std::vector<std::byte> blob = encode_edits(kName, edits);
  EXPECT_LT(blob.size(), 2000u);
  EXPECT_EQ(*decode_edits(kName, blob), edits);
}

TEST(ChunkBlob, EveryFlippedBitAndEveryCutIsNoticed) {
  Rng rng(2);
  const ChunkEdits edits = random_edits(rng, 30);
  const std::vector<std::byte> blob = encode_edits(kName, edits);
  for (std::size_t bit = 0; bit < 8 * blob.size(); ++bit) {
    std::vector<std::byte> bad = blob;
    bad[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    // A bit of zstd's header may mean nothing to it: then the edits are what they were.
    const auto decoded = decode_edits(kName, bad);
    EXPECT_TRUE(!decoded || *decoded == edits) << bit;
    EXPECT_FALSE(bit < 128 && decoded) << bit;
  }
  for (std::size_t size = 0; size < blob.size(); ++size)
    EXPECT_FALSE(decode_edits(kName, std::span(blob).first(size))) << size;
}

TEST(ChunkBlob, BytesOfAnotherPlaceOrKindAreRefused) {
  Rng rng(3);
  const std::vector<std::byte> blob = encode_edits(kName, random_edits(rng, 9));
  EXPECT_FALSE(decode_edits({kName.island + 1, kName.chunk}, blob));
  EXPECT_FALSE(decode_edits({kName.island, {-3, 4, 6}}, blob));
  EXPECT_FALSE(decode_chunk(kName, blob));
  EXPECT_FALSE(decode_edits(kName, encode_chunk(kName, random_chunk(rng))));
}

TEST(ChunkBlob, WhatNoChunkCanHoldIsRefused) {
  EXPECT_FALSE(decode_edits(kName, encode_edits(kName, {{{kChunkVoxels, kAir}}})));
  EXPECT_FALSE(decode_edits(kName, encode_edits(kName, {{{5, kAir}, {5, kAir}}})));
  EXPECT_FALSE(decode_edits(kName, encode_edits(kName, {{{5, block::kBuiltInCount}}})));
  EXPECT_FALSE(decode_chunk(kName, encode_chunk(kName, Chunk(block::kBuiltInCount))));
}

}  // namespace
}  // namespace skerry::world
