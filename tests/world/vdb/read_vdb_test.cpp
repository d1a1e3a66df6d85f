#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <map>

#include "engine/core/clock.h"
#include "tests/world/vdb/sample_files.h"
#include "world/vdb/worker.h"
#include "world/vdb_import/import.h"
#include "world/vdb_import/volume_field.h"

namespace skerry::world {
namespace {

std::vector<VolumeGrid> read_sample(const std::string& name) {
  auto grids = read_vdb(sample_files() / name);
  EXPECT_TRUE(grids) << grids.error().message;
  return grids ? std::move(*grids) : std::vector<VolumeGrid>();
}

std::map<std::string, VolumeGrid> by_name(const std::string& name) {
  std::map<std::string, VolumeGrid> out;
  for (VolumeGrid& grid : read_sample(name)) out.emplace(grid.name, std::move(grid));
  return out;
}

std::string refusal_of(const std::filesystem::path& path, const ReadLimits& limits = {}) {
  const auto grids = read_vdb(path, limits);
  return grids ? "" : grids.error().message;
}

TEST(ReadVdb, SamplesOfALevelSetLieWhereTheFileHasThem) {
  SKIP_WITHOUT_OPENVDB();
  const std::vector<VolumeGrid> grids = read_sample("ball.vdb");
  ASSERT_EQ(grids.size(), 1u);
  EXPECT_EQ(grids[0].kind, VolumeKind::kLevelSet);
  EXPECT_EQ(grids[0].background, 3.0f);
  const VolumeField field(grids[0]);
  for (int x = -30; x <= 30; ++x) {
    for (int y = -30; y <= 30; ++y) {
      for (int z = -30; z <= 30; ++z) {
        const double distance =
            std::sqrt((x - 2) * (x - 2) + (y + 3) * (y + 3) + (z - 5) * (z - 5)) - 20.0;
        const float expected =
            static_cast<float>(std::abs(distance) < 3.0 ? distance : std::copysign(3.0, distance));
        ASSERT_EQ(field.at({x, y, z}), expected) << x << ' ' << y << ' ' << z;
      }
    }
  }
  // The box is inclusive: band voxels reach less than 23 voxels from the middle.
  EXPECT_EQ(grids[0].active_box.min, (IVec3{-20, -25, -17}));
  EXPECT_EQ(grids[0].active_box.max, (IVec3{24, 19, 27}));
}

TEST(ReadVdb, AGridFurtherOutThanIslandsCanBeIsLeftOutAndNotCalledDamaged) {
  SKIP_WITHOUT_OPENVDB();
  const std::vector<VolumeGrid> grids = read_sample("far.vdb");
  ASSERT_EQ(grids.size(), 2u);
  EXPECT_EQ(grids[0].kind, VolumeKind::kOther);
  EXPECT_NE(grids[0].remark.find("2^30"), std::string::npos) << grids[0].remark;
  EXPECT_EQ(grids[0].active_box.min.x, (1 << 30) + 8);
  EXPECT_EQ(grids[1].kind, VolumeKind::kFog);
}

TEST(ReadVdb, TilesStayTiles) {
  SKIP_WITHOUT_OPENVDB();
  const std::vector<VolumeGrid> grids = read_sample("cloud.vdb");
  ASSERT_EQ(grids.size(), 1u);
  ASSERT_EQ(grids[0].tiles.size(), 1u);
  EXPECT_EQ(grids[0].tiles[0].edge, 128);
  EXPECT_EQ(grids[0].tiles[0].origin, (IVec3{128, 128, 128}));
  EXPECT_EQ(grids[0].tiles[0].value, 0.75f);
  EXPECT_EQ(grids[0].world_from_index[0][0], 0.25);
}

TEST(ReadVdb, KnowsEveryTypeByWhatItCanBeUsedFor) {
  SKIP_WITHOUT_OPENVDB();
  const std::map<std::string, VolumeGrid> grids = by_name("types.vdb");
  const std::map<std::string, std::pair<VolumeKind, float>> expected = {
      {"plain", {VolumeKind::kFog, 0.5f}},      {"double", {VolumeKind::kFog, 0.25f}},
      {"bool", {VolumeKind::kMask, 1.0f}},      {"mask", {VolumeKind::kMask, 1.0f}},
      {"int32", {VolumeKind::kIds, 7.0f}},      {"int64", {VolumeKind::kIds, 8.0f}},
      {"uint8", {VolumeKind::kIds, 9.0f}},      {"Cd", {VolumeKind::kColor, 255.0f * 65536.0f}},
      {"half", {VolumeKind::kFog, 1.5f}},       {"density[0]", {VolumeKind::kFog, 1.0f}},
      {"density[1]", {VolumeKind::kFog, 2.0f}}, {"density[2]", {VolumeKind::kFog, 3.0f}},
      {"vel", {VolumeKind::kOther, 0.0f}},      {"points", {VolumeKind::kOther, 0.0f}},
      {"frustum", {VolumeKind::kOther, 0.0f}}};
  EXPECT_EQ(grids.size(), expected.size());
  for (const auto& [name, what] : expected) {
    ASSERT_TRUE(grids.contains(name)) << name;
    const VolumeGrid& grid = grids.at(name);
    EXPECT_EQ(grid.kind, what.first) << name;
    EXPECT_EQ(VolumeField(grid).at({1, 2, 3}), what.second) << name;
    EXPECT_EQ(VolumeField(grid).at({1, 2, 4}), 0.0f) << name;
    EXPECT_EQ(grid.remark.empty(), what.first != VolumeKind::kOther) << name;
  }
}

TEST(ReadVdb, LetsNoNanAndNoInfinityThrough) {
  SKIP_WITHOUT_OPENVDB();
  const std::map<std::string, VolumeGrid> grids = by_name("wild.vdb");
  const VolumeGrid& wild = grids.at("wild");
  EXPECT_EQ(wild.replaced_values, 4u);  // three voxels, one tile
  const VolumeField field(wild);
  const float expected[] = {0.0f, 0.0f, 0.0f, 1e30f, -5.0f, 1.0f};
  for (int i = 0; i < 6; ++i) EXPECT_EQ(field.at({i, 0, 0}), expected[i]);
  EXPECT_EQ(grids.at("too_large").replaced_values, 1u);
}

TEST(ReadVdb, ImportsEveryTransform) {
  SKIP_WITHOUT_OPENVDB();
  Jobs jobs(2);
  for (const VolumeGrid& grid : read_sample("transforms.vdb")) {
    // Each box is 16 x 8 x 12 voxels of one block's volume each.
    const auto islands = import_islands({grid}, {}, jobs);
    ASSERT_TRUE(islands) << grid.name << islands.error().message;
    std::uint64_t solid = 0;
    std::vector<BlockId> voxels(kChunkVoxels);
    for (const auto& [at, chunk] : (*islands)[0].chunks) {
      chunk.unpack(voxels);
      for (const BlockId id : voxels) solid += is_solid(id) ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(solid), 16.0 * 8.0 * 12.0, 260.0) << grid.name;
  }
}

TEST(ReadVdb, CountsAMillionMillionVoxelsWithoutTouchingThem) {
  SKIP_WITHOUT_OPENVDB();
  const Stopwatch watch;
  const std::vector<VolumeGrid> grids = read_sample("huge.vdb");
  ASSERT_EQ(grids.size(), 1u);
  EXPECT_EQ(grids[0].active_voxels, 16ull << 36);
  EXPECT_EQ(grids[0].tiles.size(), 16u);
  Jobs jobs(2);
  const auto islands = import_islands(grids, {}, jobs);
  ASSERT_FALSE(islands);
  EXPECT_NE(islands.error().message.find("chunks"), std::string::npos);
  EXPECT_LT(watch.seconds(), 20.0);
}

TEST(ReadVdb, ReadsFilesWithNothingInThem) {
  SKIP_WITHOUT_OPENVDB();
  EXPECT_TRUE(read_sample("no_grids.vdb").empty());
  const std::vector<VolumeGrid> empty = read_sample("empty.vdb");
  ASSERT_EQ(empty.size(), 1u);
  EXPECT_EQ(empty[0].active_voxels, 0u);
  const auto volumes = read_volumes(sample_files() / "vectors.vdb");
  ASSERT_FALSE(volumes);
  EXPECT_NE(volumes.error().message.find("vectors.vdb"), std::string::npos);
}

TEST(ReadVdb, RefusesWhatIsNoFileOfThatKind) {
  SKIP_WITHOUT_OPENVDB();
  const Folder folder;
  EXPECT_NE(refusal_of(folder / "missing.vdb").find("No such file"), std::string::npos);
  EXPECT_NE(refusal_of(folder.path()).find("regular"), std::string::npos);
  std::ofstream(folder / "text.vdb") << "This is not a volume.\n";
  EXPECT_NE(refusal_of(folder / "text.vdb"), "");
  std::ofstream(folder / "nothing.vdb").flush();
  EXPECT_NE(refusal_of(folder / "nothing.vdb"), "");
}

TEST(ReadVdb, TellsWhichLimitAFileRanInto) {
  SKIP_WITHOUT_OPENVDB();
  const std::filesystem::path cloud = sample_files() / "cloud.vdb";
  ReadLimits small_answer;
  small_answer.answer_bytes = 10'000;
  EXPECT_NE(refusal_of(cloud, small_answer).find("more than is allowed"), std::string::npos);
  ReadLimits no_time;
  no_time.wall_s = 0.0;
  EXPECT_NE(refusal_of(cloud, no_time).find("took more than"), std::string::npos);
}

TEST(ReadVdb, AFileGetsWhatItsSizeCanNeedAndNoMore) {
  constexpr std::uint64_t kMiB = 1 << 20;
  const ReadLimits most;
  const ReadLimits small = limits_for(3400);
  EXPECT_LE(small.memory_bytes, 160 * kMiB);
  EXPECT_LE(small.answer_bytes, 32 * kMiB);
  EXPECT_LE(small.cpu_s, 5);
  const ReadLimits large = limits_for(std::uint64_t{1} << 60);
  EXPECT_EQ(large.memory_bytes, most.memory_bytes);
  EXPECT_EQ(large.answer_bytes, most.answer_bytes);
  EXPECT_EQ(large.cpu_s, most.cpu_s);
  ReadLimits tight;
  tight.cpu_s = 1;
  tight.memory_bytes = 5;
  EXPECT_EQ(limits_for(3400, tight).cpu_s, 1);
  EXPECT_EQ(limits_for(3400, tight).memory_bytes, 5u);
}

struct Cost {
  double cpu_s = 0.0;
  std::int64_t most_kib = 0;  ///< resident
  bool refused = false;
};

/// What reading a file costs the process that reads it: that of a child whose only child it is.
Cost cost_of(const std::filesystem::path& path) {
  int told[2];
  EXPECT_EQ(::pipe(told), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    Cost cost;
    cost.refused = !read_vdb(path);
    rusage spent{};
    ::getrusage(RUSAGE_CHILDREN, &spent);
    for (const timeval& time : {spent.ru_utime, spent.ru_stime})
      cost.cpu_s += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    cost.most_kib = spent.ru_maxrss;
    ::_exit(::write(told[1], &cost, sizeof cost) == sizeof cost ? 0 : 9);
  }
  ::close(told[1]);
  Cost cost;
  EXPECT_EQ(::read(told[0], &cost, sizeof cost), static_cast<ssize_t>(sizeof cost));
  ::close(told[0]);
  ::waitpid(child, nullptr, 0);
  return cost;
}

TEST(ReadVdb, ALengthBeyondTheFileIsRefusedAndCostsLittle) {
  SKIP_WITHOUT_OPENVDB();
  std::ifstream whole(sample_files() / "ball.vdb", std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(whole), {}};
  // The file's metadata follow 8 bytes of magic number, three versions, a flag and 36 letters; then
  // the number of entries; then the length of a name.
  constexpr std::size_t kCount = 8 + 3 * 4 + 1 + 36;
  for (const std::size_t at : {kCount, kCount + 4}) {
    std::string bad = bytes;
    for (std::size_t i = 0; i < 4; ++i) bad[at + i] = static_cast<char>(i == 3 ? 0x7f : 0xff);
    const Folder folder;
    std::ofstream(folder / "bad.vdb", std::ios::binary) << bad;
    const Cost cost = cost_of(folder / "bad.vdb");
    EXPECT_TRUE(cost.refused);
    EXPECT_LT(cost.most_kib, 256 << 10);  // the length says 2 GiB
    EXPECT_LT(cost.cpu_s, 6.0);           // four and what is spent at the start
  }
}

TEST(ReadVdb, ReportsProgressUpToTheWholeFile) {
  SKIP_WITHOUT_OPENVDB();
  double last = 0.0;
  const auto grids = read_vdb(sample_files() / "ball.vdb", {}, [&last](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1.0);
    last = share;
  });
  ASSERT_TRUE(grids);
}

TEST(ReadVdb, SealsWhatAChildMightStillChange) {
  Result<MemoryFile> file = MemoryFile::create();
  ASSERT_TRUE(file) << file.error().message;
  const std::byte bytes[4] = {};
  ASSERT_TRUE(file->append(bytes));
  const auto sealed = file->seal();
  ASSERT_TRUE(sealed);
  EXPECT_EQ(sealed->size(), 4u);
  EXPECT_LT(::write(file->descriptor(), bytes, 1), 0);
}

}  // namespace
}  // namespace skerry::world
