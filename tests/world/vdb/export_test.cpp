#include "world/vdb/export.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "tests/world/vdb/sample_files.h"
#include "tests/world/vdb/volumes.h"
#include "world/islands/stored_voxels.h"
#include "world/mesh/mesh.h"
#include "world/vdb_import/import.h"
#include "world/voxel/hash.h"

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

/// Blocks of an island by lattice place.
using Blocks = std::map<IVec3, BlockId>;

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

bool holds(const BlockBox& box, glm::dvec3 p) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (p[axis] < static_cast<double>(box.low[a]) || p[axis] >= static_cast<double>(box.high[a]))
      return false;
  }
  return true;
}

glm::dvec3 centre_of(const Pose& pose, IVec3 voxel) {
  return difference_blocks(pose.origin, {}) +
         pose.rotation * (glm::dvec3{voxel.x, voxel.y, voxel.z} + 0.5);
}

/// Islands with a block in the box.
std::map<std::uint64_t, Blocks> blocks_in(World& world, const BlockBox& box) {
  std::map<std::uint64_t, Blocks> out;
  for (const IslandSpec& spec : world.islands_near({}, 1e6, 0.0)) {
    const Pose pose = pose_at(spec, 0.0);
    std::vector<BlockId> padded(kPaddedVoxels);
    for (const IVec3 at : world.chunks(spec.id, 0)) {
      if (!world.generate_padded(spec.id, at, 0, padded)) continue;
      for_each_block(chunk_from_padded(padded), at, [&](IVec3 voxel, BlockId id) {
        if (holds(box, centre_of(pose, voxel))) out[spec.id].emplace(voxel, id);
      });
    }
  }
  return out;
}

/// Whether each block of an island stands where one of the other's does, and no block is missing.
bool equal(const ImportedIsland& island, const IslandSpec& spec, const Blocks& blocks) {
  if (island.blocks != blocks.size()) return false;
  const Pose pose = pose_at(island.spec, 0.0), original = pose_at(spec, 0.0);
  bool same = true;
  for (const auto& [at, chunk] : island.chunks) {
    for_each_block(chunk, at, [&](IVec3 voxel, BlockId id) {
      const glm::dvec3 p = glm::inverse(original.rotation) *
                           (centre_of(pose, voxel) - difference_blocks(original.origin, {}));
      const glm::dvec3 low = glm::floor(p);
      const glm::dvec3 off = glm::abs(p - low - 0.5);
      const auto found =
          blocks.find({static_cast<std::int32_t>(low.x), static_cast<std::int32_t>(low.y),
                       static_cast<std::int32_t>(low.z)});
      // Places are kept to 1/65536 block.
      same = same && std::max({off.x, off.y, off.z}) < 1e-4 && found != blocks.end() &&
             found->second == id;
    });
  }
  return same;
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
    const std::map<std::uint64_t, Blocks> expected = blocks_in(random_world.world, box);
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
    ASSERT_EQ(islands->size(), expected.size()) << seed;
    for (const auto& [id, made] : expected) {
      const auto& blocks = made;
      const IslandSpec spec = *random_world.world.island(id);
      EXPECT_EQ(std::count_if(islands->begin(), islands->end(),
                              [&](const auto& island) { return equal(island, spec, blocks); }),
                1)
          << seed;
    }
    ++compared;
  }
  EXPECT_GE(compared, 8);
}

TEST(VdbExport, ImportsBackToTheSameBlocksOfASeedsIslands) {
  SKIP_WITHOUT_OPENVDB();
  const Folder folder;
  Jobs jobs(2);
  for (const std::uint64_t seed : {1u, 7u}) {
    World world(WorldDesc{.seed = seed});
    const Spawn spawn = world.spawn();
    const glm::dvec3 feet = difference_blocks(spawn.feet, {});
    BlockBox box;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      box.low[a] = static_cast<std::int64_t>(feet[axis]) - 40;
      box.high[a] = box.low[a] + 75;
    }
    const auto grids = volumes_of(world, box);
    ASSERT_TRUE(grids) << grids.error().message;
    ASSERT_TRUE(write_vdb(*grids, folder / "seed.vdb"));
    const auto back = read_vdb(folder / "seed.vdb");
    ASSERT_TRUE(back) << back.error().message;
    const auto islands = import_islands(*back, {.grid = back->front().name}, jobs);
    ASSERT_TRUE(islands) << islands.error().message;
    Blocks blocks;
    const Pose pose = *world.pose(spawn.island, 0.0);
    std::vector<BlockId> padded(kPaddedVoxels);
    for (const IVec3 at : world.chunks(spawn.island, 0)) {
      if (!world.generate_padded(spawn.island, at, 0, padded)) continue;
      for_each_block(chunk_from_padded(padded), at, [&](IVec3 voxel, BlockId id) {
        if (holds(box, centre_of(pose, voxel))) blocks.emplace(voxel, id);
      });
    }
    EXPECT_GT(blocks.size(), 10'000u);
    EXPECT_TRUE(equal(islands->front(), *world.island(spawn.island), blocks)) << seed;
  }
}

TEST(VdbExport, TellsVolumesApartByTheirValuesAlone) {
  VolumeGrid whole;
  whole.tiles = {{{-64, 0, 64}, 64, 3.0f}};
  VolumeGrid parts;
  for (int x = 0; x < 64; x += 16)
    for (int y = 0; y < 64; y += 16)
      for (int z = 0; z < 64; z += 16) parts.tiles.push_back({{x - 64, y, z + 64}, 16, 3.0f});
  EXPECT_EQ(content_hash(whole), content_hash(parts));
  parts.tiles[5].value = 4.0f;
  EXPECT_NE(content_hash(whole), content_hash(parts));
  VolumeGrid moved = whole;
  moved.tiles[0].origin.y = 64;
  EXPECT_NE(content_hash(whole), content_hash(moved));
  const VolumeGrid bricks = filled_volume(VolumeKind::kIds, {0, 0, 0}, {20, 9, 9}, 0.0f,
                                          [](IVec3 at) { return static_cast<float>(at.x); });
  VolumeGrid changed = bricks;
  std::swap(changed.bricks[0].values[0], changed.bricks[0].values[100]);
  EXPECT_NE(content_hash(bricks), content_hash(changed));
}

TEST(VdbExport, TakesWholeChunksOfATurnedIslandThatABoxCuts) {
  std::map<IVec3, Chunk> chunks;
  for (int x = -2; x < 2; ++x)
    for (int y = -1; y < 1; ++y)
      for (int z = -2; z < 2; ++z) chunks.insert_or_assign({x, y, z}, Chunk(block::kStone));
  World world(RandomWorld::desc());
  IslandSpec spec;
  spec.id = 1;
  spec.yaw_rad = 0.6;
  const auto voxels = std::make_shared<const StoredVoxels>(std::move(chunks));
  world.add_island(fitted(spec, *voxels), voxels);
  const BlockBox box{{-150, -100, -110}, {90, 60, 110}};
  const auto grids = volumes_of(world, box);
  ASSERT_TRUE(grids) << grids.error().message;
  const std::map<std::uint64_t, Blocks> expected = blocks_in(world, box);
  EXPECT_EQ(grids->front().active_voxels, expected.at(1).size());
  // Those wholly inside are tiles still.
  EXPECT_GE(std::count_if(grids->front().tiles.begin(), grids->front().tiles.end(),
                          [](const VolumeTile& tile) { return tile.edge == kChunkEdge; }),
            1);
}

TEST(VdbExport, RefusesABoxThatNobodyCouldSearchInASeedsWorld) {
  World world(WorldDesc{.seed = 1});
  constexpr std::int64_t kFar = kMaxBlock;
  const auto grids = volumes_of(world, {{-kFar, -100, -kFar}, {kFar, 100, kFar}});
  ASSERT_FALSE(grids);
  EXPECT_NE(grids.error().message.find("--box"), std::string::npos);
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
