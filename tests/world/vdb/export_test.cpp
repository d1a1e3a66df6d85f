#include "world/vdb/export.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <memory>

#include "tests/world/vdb/sample_files.h"
#include "world/hash.h"
#include "world/stored_voxels.h"
#include "world/vdb/import.h"

namespace skerry::world {
namespace {

/// A world of random islands: turned, in places of their own, made of random blocks in blobs.
struct RandomWorld {
  explicit RandomWorld(std::uint64_t seed) : world(desc()) {
    Rng random(seed);
    const int islands = random.in(1, 3);
    for (int i = 0; i < islands; ++i) add(random, static_cast<std::uint64_t>(i) + 1);
  }

  static WorldDesc desc() {
    WorldDesc out;
    out.generated = false;
    return out;
  }

  void add(Rng& random, std::uint64_t id) {
    std::map<IVec3, Chunk> chunks;
    for (int blob = random.in(1, 4); blob > 0; --blob) {
      const IVec3 at{random.in(-2, 1), random.in(-2, 1), random.in(-2, 1)};
      const auto block = static_cast<BlockId>(random.in(1, block::kBuiltInCount - 1));
      if (random.chance(100)) {
        chunks.insert_or_assign(at, Chunk(block));
        continue;
      }
      Chunk& chunk = chunks.try_emplace(at, Chunk(kAir)).first->second;
      for (int voxel = random.in(1, 3000); voxel > 0; --voxel)
        chunk.set(random.in(0, 63), random.in(0, 63), random.in(0, 63), block);
    }
    IslandSpec spec;
    spec.id = id;
    spec.origin = {random.in(-300, 300) * kUnitsPerBlock, random.in(-300, 300) * kUnitsPerBlock,
                   random.in(-300, 300) * kUnitsPerBlock};
    spec.yaw_rad = random.in(-3, 3);
    const auto voxels = std::make_shared<const StoredVoxels>(std::move(chunks));
    world.add_island(fitted(spec, *voxels), voxels);
  }

  World world;
};

using Placed = std::map<IVec3, BlockId>;  // by lattice place in 1/16 block of the world

/// Where a block stands, fine enough to tell neighbours apart on islands that are turned, coarse
/// enough to forgive the rounding of places to 1/65536 block.
void place(Placed& out, const Pose& pose, IVec3 voxel, BlockId id) {
  const glm::dvec3 p = difference_blocks(pose.origin, {}) +
                       pose.rotation * (glm::dvec3{voxel.x, voxel.y, voxel.z} + 0.5);
  const auto round = [](double v) { return static_cast<std::int32_t>(std::floor(v * 4.0 + 0.5)); };
  out[{round(p.x + 0.037), round(p.y + 0.037), round(p.z + 0.037)}] = id;
}

template <class Use>
void for_each_block(const Chunk& chunk, IVec3 at, Use&& use) {
  std::vector<BlockId> voxels(kChunkVoxels);
  chunk.unpack(voxels);
  for (int y = 0; y < kChunkEdge; ++y)
    for (int x = 0; x < kChunkEdge; ++x)
      for (int z = 0; z < kChunkEdge; ++z)
        if (const BlockId id = voxels[voxel_index(x, y, z)]; id != kAir)
          use(IVec3{at.x * kChunkEdge + x, at.y * kChunkEdge + y, at.z * kChunkEdge + z}, id);
}

Placed blocks_in(World& world, const BlockBox& box) {
  Placed out;
  for (const IslandSpec& spec : world.islands_near({}, 1e6, 0.0)) {
    const Pose pose = pose_at(spec, 0.0);
    std::vector<BlockId> padded(kPaddedVoxels);
    for (const IVec3 at : world.chunks(spec.id, 0)) {
      if (!world.generate_padded(spec.id, at, 0, padded)) continue;
      for_each_block(chunk_from_padded(padded), at, [&](IVec3 voxel, BlockId id) {
        const glm::dvec3 p = difference_blocks(pose.origin, {}) +
                             pose.rotation * (glm::dvec3{voxel.x, voxel.y, voxel.z} + 0.5);
        for (int axis = 0; axis < 3; ++axis) {
          const auto a = static_cast<std::size_t>(axis);
          if (p[axis] < static_cast<double>(box.low[a]) ||
              p[axis] >= static_cast<double>(box.high[a]))
            return;
        }
        place(out, pose, voxel, id);
      });
    }
  }
  return out;
}

Placed blocks_of(const std::vector<ImportedIsland>& islands) {
  Placed out;
  for (const ImportedIsland& island : islands)
    for (const auto& [at, chunk] : island.chunks)
      for_each_block(chunk, at, [&](IVec3 voxel, BlockId id) {
        place(out, pose_at(island.spec, 0.0), voxel, id);
      });
  return out;
}

TEST(VdbExport, ImportsBackToTheSameBlocksForAnyWorldAndBox) {
  SKIP_WITHOUT_OPENVDB();
  const Folder folder;
  Jobs jobs(2);
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    RandomWorld random_world(seed);
    Rng random(seed + 1000);
    BlockBox box{{-1000, -1000, -1000}, {1000, 1000, 1000}};
    for (std::size_t axis = 0; seed % 3 != 0 && axis < 3; ++axis) {
      box.low[axis] = random.in(-400, 50);
      box.high[axis] = random.in(60, 500);
    }
    const Placed expected = blocks_in(random_world.world, box);
    const auto grids = volumes_of(random_world.world, box);
    ASSERT_EQ(static_cast<bool>(grids), !expected.empty()) << seed;
    if (expected.empty()) continue;
    const std::filesystem::path path = folder / "world.vdb";
    const Result<void> written = write_vdb(*grids, path);
    ASSERT_TRUE(written) << written.error().message;
    const auto back = read_vdb(path);
    ASSERT_TRUE(back) << back.error().message;
    const auto islands = import_islands(*back, {}, jobs);
    ASSERT_TRUE(islands) << islands.error().message;
    EXPECT_TRUE(blocks_of(*islands) == expected) << seed;
    ++compared;
  }
  EXPECT_GE(compared, 8);
}

TEST(VdbExport, IsReadByTheToolsOfOthers) {
  SKIP_WITHOUT_OPENVDB();
  if (std::system("command -v vdb_print >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "vdb_print is not installed (libopenvdb-tools)";
  const Folder folder;
  RandomWorld random_world(3);
  const auto grids = volumes_of(random_world.world, {{-1000, -1000, -1000}, {1000, 1000, 1000}});
  ASSERT_TRUE(grids);
  ASSERT_TRUE(write_vdb(*grids, folder / "w.vdb"));
  std::string told;
  FILE* pipe = ::popen(("vdb_print -m " + (folder / "w.vdb").string()).c_str(), "r");
  char buffer[4096];
  while (std::fgets(buffer, sizeof(buffer), pipe)) told += buffer;
  EXPECT_EQ(::pclose(pipe), 0);
  for (const VolumeGrid& grid : *grids) {
    EXPECT_NE(told.find(grid.name), std::string::npos) << told;
    EXPECT_NE(told.find(std::to_string(grid.active_voxels)), std::string::npos) << told;
  }
  EXPECT_NE(told.find("int32"), std::string::npos) << told;
  EXPECT_NE(told.find("fog volume"), std::string::npos) << told;
  EXPECT_NE(told.find("blosc"), std::string::npos) << told;
}

TEST(VdbExport, LeavesNothingBehindWhenItFails) {
  SKIP_WITHOUT_OPENVDB();
  const Folder folder;
  RandomWorld random_world(1);
  const auto grids = volumes_of(random_world.world, {{-1000, -1000, -1000}, {1000, 1000, 1000}});
  ASSERT_TRUE(grids);
  const Result<void> written = write_vdb(*grids, folder / "no_such_folder" / "w.vdb");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("w.vdb"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace skerry::world
