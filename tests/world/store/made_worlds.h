// Worlds for the tests of world/store.
#pragma once
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "tests/folder.h"
#include "world/islands/stored_voxels.h"
#include "world/store/chunk_blob.h"
#include "world/store/world_file.h"
#include "world/voxel/hash.h"

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

inline void run_sql(const std::filesystem::path& path, const std::string& sql) {
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(db);
  sqlite3_close(db);
}

/// Keeps what is committed from now on from leaving the log. Each commit waits two seconds for it.
class HeldReader {
 public:
  explicit HeldReader(const std::filesystem::path& path) {
    sqlite3_open(path.c_str(), &db_);
    EXPECT_EQ(sqlite3_exec(db_, "BEGIN; SELECT * FROM value", nullptr, nullptr, nullptr),
              SQLITE_OK);
  }
  ~HeldReader() { sqlite3_close(db_); }
  HeldReader(const HeldReader&) = delete;
  HeldReader& operator=(const HeldReader&) = delete;

 private:
  sqlite3* db_ = nullptr;
};

inline void expect_refused(const std::filesystem::path& path, WorldFile::Mode mode,
                           std::string_view why) {
  const auto file = WorldFile::open(path, mode);
  ASSERT_FALSE(file) << why;
  const std::string& text = file.error().message;
  EXPECT_NE(text.find(why), std::string::npos) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  EXPECT_NE(text.find(';'), std::string::npos) << "says not what to do: " << text;
}

/// What a file was given.
struct Given {
  std::map<std::uint64_t, IslandRow> islands;
  std::map<ChunkName, ChunkEdits> edits;
  std::map<ChunkName, Chunk> chunks;
};

/// Puts islands of all kinds into a file, over several transactions that overwrite one another.
inline Given fill(WorldFile& file, Rng& rng, int islands) {
  Given given;
  for (int pass = 0; pass < 3; ++pass) {
    WorldFile::Transaction transaction = file.begin();
    for (int i = 0; i < islands; ++i) {
      IslandRow row;
      row.spec.id = mix64(static_cast<std::uint64_t>(i));
      row.spec.origin = {rng.in(-9999, 9999), rng.in(-9999, 9999), rng.in(-9999, 9999)};
      row.spec.yaw_rad = 1.0 / 3.0;
      row.added = i % 2 == 0;
      if (i % 3 == 0) row.motion = random_motion(rng);
      given.islands[row.spec.id] = row;
      transaction.put_island(row);
      for (int c = 0; c < 4; ++c) {
        const ChunkName name{row.spec.id, {rng.in(-2, 1), rng.in(-2, 1), rng.in(-2, 1)}};
        if (row.added) {
          given.chunks.insert_or_assign(name, random_chunk(rng));
          transaction.put_chunk(name.island, name.chunk, given.chunks.at(name));
        } else {
          given.edits[name] = random_edits(rng, 400);
          transaction.put_edits(name.island, name.chunk, given.edits.at(name));
        }
      }
    }
    EXPECT_TRUE(transaction.commit());
  }
  return given;
}

inline std::size_t expect_same(const Given& given, const WorldFile::Contents& contents) {
  for (const IslandRow& row : contents.islands) {
    const IslandRow& expected = given.islands.at(row.spec.id);
    EXPECT_EQ(row.added, expected.added);
    EXPECT_EQ(row.spec.origin, expected.spec.origin);
    EXPECT_EQ(row.spec.yaw_rad, expected.spec.yaw_rad);
  }
  for (const auto& e : contents.edits) EXPECT_EQ(e.edits, given.edits.at({e.island, e.chunk}));
  for (const auto& c : contents.chunks)
    EXPECT_EQ(blocks_of(c.voxels), blocks_of(given.chunks.at({c.island, c.chunk})));
  return contents.edits.size() + contents.chunks.size();
}

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace skerry::world
