// Worlds for the tests of world/store.
#pragma once
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <set>

#include "tests/folder.h"
#include "world/hash.h"
#include "world/store/chunk_blob.h"
#include "world/store/world_file.h"
#include "world/stored_voxels.h"

namespace skerry::world {

inline IslandSpec spec_of(std::uint64_t id, WorldPos origin = {}) {
  IslandSpec spec;
  spec.id = id;
  spec.origin = origin;
  return spec;
}

inline WorldInfo info_of_seed_4() {
  WorldInfo info{"Fjord", "4", {}};
  info.desc.seed = 4;
  info.desc.offset_blocks = {1'000'000, -5, 77};
  return info;
}

inline ChunkEdits random_edits(Rng& rng, std::size_t most) {
  std::map<std::uint32_t, BlockId> edits;
  const int count = rng.in(1, static_cast<int>(most));
  for (int i = 0; i < count; ++i)
    edits[static_cast<std::uint32_t>(rng.in(0, kChunkVoxels - 1))] =
        static_cast<BlockId>(rng.in(0, block::kBuiltInCount - 1));
  ChunkEdits out;
  for (const auto& [index, id] : edits) out.push_back({index, id});
  return out;
}

inline Chunk random_chunk(Rng& rng) {
  std::vector<BlockId> blocks(kChunkVoxels, kAir);
  for (int i = rng.in(1, 3000); i > 0; --i)
    blocks[static_cast<std::size_t>(rng.in(0, kChunkVoxels - 1))] =
        static_cast<BlockId>(rng.in(0, block::kBuiltInCount - 1));
  blocks[0] = block::kStone;
  return Chunk::from_voxels(blocks);
}

/// An upright pose and a motion without round numbers.
inline MotionState random_motion(Rng& rng) {
  const auto real = [&] { return rng.in(-1'000'000, 1'000'000) / 37'117.0; };
  MotionState motion;
  motion.tick = rng.in(0, 1'000'000);
  motion.pose.origin = {rng.in(-99999, 99999), rng.in(-99999, 99999), rng.in(-99999, 99999)};
  const double half = real();
  motion.pose.rotation = glm::dquat{std::cos(half), 0.0, std::sin(half), 0.0};
  motion.velocity = {real(), real(), real()};
  motion.spin = real();
  return motion;
}

inline std::vector<BlockId> blocks_of(const Chunk& chunk) {
  std::vector<BlockId> blocks(kChunkVoxels);
  chunk.unpack(blocks);
  return blocks;
}

}  // namespace skerry::world
