#include "world/store/world_file.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <fstream>

#include "tests/world/store/made_worlds.h"
#include "world/generate/generate.h"

namespace skerry::world {
namespace {

namespace fs = std::filesystem;
using Mode = WorldFile::Mode;

TEST(WorldFile, WhatWasCommittedIsRead) {
  Rng rng(7);
  for (int round = 0; round < 4; ++round) {
    const Folder folder;
    const fs::path path = folder / "a world.skerry";
    Given given;
    {
      auto file = WorldFile::create(path, info_of_seed_4());
      ASSERT_TRUE(file) << file.error().message;
      given = fill(**file, rng, 3 + 4 * round);
      EXPECT_FALSE((*file)->value("play"));
      auto transaction = (*file)->begin();
      transaction.put_value("play", std::as_bytes(std::span("here")));
      ASSERT_TRUE(transaction.commit());
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1) << "one file a world";
    auto file = WorldFile::open(path, Mode::kRead);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ((*file)->info(), info_of_seed_4());
    ASSERT_TRUE((*file)->value("play"));
    EXPECT_EQ((*file)->value("play")->size(), 5u);
    const WorldFile::Contents contents = (*file)->read();
    EXPECT_EQ(expect_same(given, contents), given.edits.size() + given.chunks.size());
    ASSERT_EQ(contents.islands.size(), given.islands.size());
    for (const IslandRow& row : contents.islands)
      EXPECT_EQ(row.motion, given.islands.at(row.spec.id).motion);  // bit for bit
    EXPECT_TRUE((*file)->damage().empty());
  }
}

TEST(WorldFile, ReadingLeavesTheFolderAsItWas) {
  const Folder folder;
  const fs::path path = folder / "w";
  Rng rng(7);
  {
    auto file = WorldFile::create(path, info_of_seed_4());
    ASSERT_TRUE(file) << file.error().message;
    fill(**file, rng, 3);
  }
  const auto bytes_of = [&] {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string before = bytes_of();
  {
    const auto first = WorldFile::open(path, Mode::kRead);
    const auto second = WorldFile::open(path, Mode::kRead);
    ASSERT_TRUE(first && second);
    EXPECT_FALSE((*first)->read().islands.empty());
    EXPECT_FALSE((*second)->read().islands.empty());
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
  EXPECT_EQ(bytes_of(), before);
}

TEST(WorldFile, ANameOrSeedTooLongIsRefused) {
  const Folder folder;
  EXPECT_FALSE(WorldFile::create(folder / "a.skerry", {std::string(201, 'n'), "1", {}}));
  EXPECT_FALSE(WorldFile::create(folder / "b.skerry", {"n", std::string(4097, '1'), {}}));
  EXPECT_TRUE(
      WorldFile::create(folder / "c.skerry", {std::string(200, 'n'), std::string(4096, '1'), {}}));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.skerry"));
}

TEST(WorldFile, ATransactionLeftAloneChangesNothing) {
  const Folder folder;
  auto file = WorldFile::create(folder / "w", info_of_seed_4());
  ASSERT_TRUE(file);
  {
    auto transaction = (*file)->begin();
    transaction.put_value("x", {});
  }
  EXPECT_FALSE((*file)->value("x"));
  auto transaction = (*file)->begin();
  transaction.put_value("x", {});
  ASSERT_TRUE(transaction.commit());
  EXPECT_TRUE((*file)->value("x"));
}

TEST(WorldFile, EditsTakenBackLeaveNoRow) {
  const Folder folder;
  auto file = WorldFile::create(folder / "w", info_of_seed_4());
  ASSERT_TRUE(file);
  for (const bool some : {true, false}) {
    auto transaction = (*file)->begin();
    transaction.put_island({spec_of(9)});
    transaction.put_edits(9, {}, some ? ChunkEdits{{1, block::kStone}} : ChunkEdits{});
    ASSERT_TRUE(transaction.commit());
    EXPECT_EQ((*file)->read().edits.size(), some ? 1u : 0u);
  }
}

TEST(WorldFile, OnlyOneWritesAndOthersReadMeanwhile) {
  const Folder folder;
  const fs::path path = folder / "w";
  auto writer = WorldFile::create(path, info_of_seed_4());
  ASSERT_TRUE(writer);
  expect_refused(path, Mode::kWrite, "another Skerry has it open");
  {
    auto reader = WorldFile::open(path, Mode::kRead);
    ASSERT_TRUE(reader);
    auto transaction = (*writer)->begin();
    transaction.put_value("x", {});
    ASSERT_TRUE(transaction.commit());
    EXPECT_TRUE((*reader)->value("x"));
  }
  *writer = nullptr;
  EXPECT_TRUE(WorldFile::open(path, Mode::kWrite));
}

TEST(WorldFile, TheLockOfAnotherProcessEndsWithIt) {
  const Folder folder;
  const fs::path path = folder / "w";
  ASSERT_TRUE(WorldFile::create(path, info_of_seed_4()));
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const auto held = WorldFile::open(path, Mode::kWrite);
    const char done = held ? 'y' : 'n';
    if (::write(ready[1], &done, 1) == 1) ::pause();
    ::_exit(0);
  }
  char done = 0;
  ASSERT_EQ(::read(ready[0], &done, 1), 1);
  ASSERT_EQ(done, 'y');
  expect_refused(path, Mode::kWrite, "another Skerry has it open");
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_TRUE(WorldFile::open(path, Mode::kWrite));
}

TEST(WorldFile, WhatIsNoWorldIsRefusedAndLeftAlone) {
  const Folder folder;
  std::ofstream(folder / "text") << std::string(5000, 'x');
  const std::ofstream empty(folder / "empty");
  run_sql(folder / "foreign", "CREATE TABLE t(x); PRAGMA user_version = 1");
  for (const Mode mode : {Mode::kRead, Mode::kWrite}) {
    expect_refused(folder / "none", mode, "does not exist");
    expect_refused(folder.path(), mode, "is a folder");
    expect_refused("/dev/null", mode, "is no file");
    expect_refused(folder / "text", mode, "no saved world");
    expect_refused(folder / "empty", mode, "no saved world");
    const auto before = fs::last_write_time(folder / "foreign");
    expect_refused(folder / "foreign", mode, "another program");
    EXPECT_EQ(fs::last_write_time(folder / "foreign"), before);
  }
  ASSERT_TRUE(WorldFile::create(folder / "w", info_of_seed_4()));
  const auto again = WorldFile::create(folder / "w", info_of_seed_4());
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().message.find("one already"), std::string::npos);
  EXPECT_FALSE(WorldFile::create("/no/such/folder/w", info_of_seed_4()));
}

TEST(WorldFile, ANewerVersionIsRefusedWhateverItsTablesAndLeftAsItIs) {
  const auto with_flipped_magic = [](const fs::path& path) {
    std::fstream(path, std::ios::binary | std::ios::in | std::ios::out).write("T", 1);
  };
  for (const char* sql :
       {"PRAGMA user_version = 4; CREATE TABLE news(x)", "PRAGMA user_version = 4",
        "PRAGMA user_version = 7", "PRAGMA user_version = 2147483647",
        "PRAGMA user_version = 4; DROP TABLE spare", "PRAGMA user_version = 4; DROP TABLE value"}) {
    for (const bool damaged : {false, true}) {
      const Folder folder;
      const fs::path path = folder / "w";
      ASSERT_TRUE(WorldFile::create(path, info_of_seed_4()));
      run_sql(path, sql);
      if (damaged) with_flipped_magic(path);
      const std::string before = bytes_of(path);
      for (const Mode mode : {Mode::kRead, Mode::kWrite})
        expect_refused(path, mode, "newer Skerry");
      EXPECT_EQ(bytes_of(path), before) << sql;
      EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1) << sql;
    }
  }
}

TEST(WorldFile, AnotherApplicationIdIsLeftAsItIs) {
  const Folder folder;
  const fs::path path = folder / "w";
  ASSERT_TRUE(WorldFile::create(path, info_of_seed_4()));
  run_sql(path, "PRAGMA application_id = 5");
  const std::string before = bytes_of(path);
  for (const Mode mode : {Mode::kRead, Mode::kWrite}) expect_refused(path, mode, "newer Skerry");
  EXPECT_EQ(bytes_of(path), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(WorldFile, AFileOfVersionOneIsReadAndBroughtUpToDate) {
  const Folder folder;
  const fs::path path = folder / "w";
  Given given;
  {
    Rng rng(8);
    auto file = WorldFile::create(path, info_of_seed_4());
    ASSERT_TRUE(file);
    given = fill(**file, rng, 4);
  }
  run_sql(path, "DROP TABLE motion; DROP TABLE spare; PRAGMA user_version = 1");
  for (const Mode mode : {Mode::kRead, Mode::kWrite, Mode::kRead}) {
    auto file = WorldFile::open(path, mode);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(expect_same(given, (*file)->read()), given.edits.size() + given.chunks.size());
    if (mode == Mode::kRead) continue;
    auto transaction = (*file)->begin();
    IslandRow row = given.islands.begin()->second;
    row.motion = MotionState{};
    transaction.put_island(row);
    ASSERT_TRUE(transaction.commit());
  }
}

TEST(WorldFile, AFullDiskIsToldAndNothingIsLost) {
  const Folder folder;
  const fs::path path = folder / "w";
  ASSERT_TRUE(WorldFile::create(path, info_of_seed_4()));
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    auto file = WorldFile::open(path, Mode::kWrite);
    Rng rng(5);
    const auto save = [&](int count) {
      auto transaction = (*file)->begin();
      transaction.put_island({spec_of(9), true});
      for (int i = 0; i < count; ++i) transaction.put_chunk(9, {i, 0, 0}, random_chunk(rng));
      return transaction.commit();
    };
    bool fine = static_cast<bool>(save(2));
    const rlimit small{200'000, RLIM_INFINITY};
    ::setrlimit(RLIMIT_FSIZE, &small);
    const Result<void> failed = save(200);
    fine = fine && !failed && failed.error().message.find('\n') == std::string::npos;
    const rlimit large{RLIM_INFINITY, RLIM_INFINITY};
    ::setrlimit(RLIMIT_FSIZE, &large);
    fine = fine && (*file)->read().chunks.size() == 2 && save(200);
    *file = nullptr;
    ::_exit(fine ? 0 : 1);
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  auto file = WorldFile::open(path, Mode::kRead);
  ASSERT_TRUE(file);
  EXPECT_EQ((*file)->read().chunks.size(), 200u);
}

TEST(WorldFile, WithoutPermissionItIsReadButNotWritten) {
  const Folder folder;
  const fs::path path = folder / "w";
  ASSERT_TRUE(WorldFile::create(path, info_of_seed_4()));
  // Root, as which tests may run, may do everything: the child is somebody else.
  fs::permissions(folder.path(), static_cast<fs::perms>(0555));
  fs::permissions(path, static_cast<fs::perms>(0444));
  const pid_t child = ::fork();
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    if (::geteuid() == 0 && ::seteuid(kNobody) != 0) ::_exit(2);
    const auto writer = WorldFile::open(path, Mode::kWrite);
    const auto reader = WorldFile::open(path, Mode::kRead);
    const bool told =
        !writer && writer.error().message.find("may not be written") != std::string::npos;
    ::_exit(told && reader ? 0 : 1);
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  fs::permissions(folder.path(), fs::perms::owner_all);  // so that it can be taken away
}

TEST(LoadWorld, EditsIslandsAndMotionsComeBackExactly) {
  const Folder folder;
  const fs::path path = folder / "w";
  Rng rng(3);
  const WorldInfo info = info_of_seed_4();
  World world(info.desc);
  const std::vector<IslandSpec> near = world.islands_near(world.origin(), 200.0, 0.0);
  ASSERT_FALSE(near.empty());
  const IslandSpec& home = near.front();
  const ChunkEdits edits = random_edits(rng, 500);
  const Chunk chunk = random_chunk(rng);
  const MotionState motion = random_motion(rng);
  {
    auto file = WorldFile::create(path, info);
    ASSERT_TRUE(file);
    auto transaction = (*file)->begin();
    transaction.put_island({home, false, motion});
    transaction.put_edits(home.id, {0, 0, 0}, edits);
    transaction.put_island({spec_of(77, {5, 6, 7}), true});
    transaction.put_chunk(77, {-1, 0, 0}, chunk);
    transaction.put_island({spec_of(1)});  // of no seed
    transaction.put_edits(1, {0, 0, 0}, edits);
    ASSERT_TRUE(transaction.commit());
  }
  auto file = WorldFile::open(path, Mode::kRead);
  ASSERT_TRUE(file);
  LoadedWorld loaded = load_world(**file);
  EXPECT_EQ(loaded.world->edits(home.id, {0, 0, 0}), edits);
  EXPECT_TRUE(loaded.world->take_edits().empty());
  EXPECT_EQ(blocks_of(loaded.world->chunk_now(77, {-1, 0, 0})), blocks_of(chunk));
  EXPECT_EQ(loaded.world->added_islands(), std::vector<std::uint64_t>{77});
  ASSERT_EQ(loaded.moving.size(), 1u);
  EXPECT_EQ(loaded.moving[0].state, motion);
  EXPECT_EQ(loaded.world->pose(home.id, 1.0)->origin, motion.pose.origin);
  EXPECT_EQ((*file)->damage().size(), 1u);  // the island that the seed does not make
}

TEST(WorldFile, TheLogOfAWorldThatIsNoMoreIsNotReadIntoANewOne) {
  const Folder folder;
  const fs::path path = folder / "w", log = folder / "w-wal", aside = folder / "aside";
  {
    auto file = WorldFile::create(path, info_of_seed_4());
    ASSERT_TRUE(file);
    const HeldReader reader(path);
    auto transaction = (*file)->begin();
    transaction.put_island({spec_of(77), true});
    ASSERT_TRUE(transaction.commit());
    fs::copy_file(log, aside);
    ASSERT_GT(fs::file_size(aside), 0u);
  }
  fs::remove(path);
  fs::rename(aside, log);
  WorldInfo other = info_of_seed_4();
  other.name = "Other";
  auto file = WorldFile::create(path, other);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ((*file)->info(), other);
  EXPECT_TRUE((*file)->read().islands.empty());
  EXPECT_FALSE(WorldFile::create(path, other)) << "there is one already";
}

TEST(WorldFile, ANewIslandHasNothingOfAnEarlierOneOfItsId) {
  const Folder folder;
  Rng rng(5);
  auto file = WorldFile::create(folder / "w", info_of_seed_4());
  ASSERT_TRUE(file);
  {
    auto transaction = (*file)->begin();
    transaction.put_island({spec_of(77), true, random_motion(rng)});
    transaction.put_chunk(77, {0, 0, 0}, random_chunk(rng));
    transaction.put_chunk(77, {3, 0, 0}, random_chunk(rng));
    transaction.put_chunk(78, {3, 0, 0}, random_chunk(rng));
    transaction.put_island({spec_of(78), true});
    ASSERT_TRUE(transaction.commit());
  }
  auto transaction = (*file)->begin();
  transaction.put_new_island({spec_of(77), true});
  transaction.put_chunk(77, {0, 0, 0}, random_chunk(rng));
  ASSERT_TRUE(transaction.commit());
  const WorldFile::Contents contents = (*file)->read();
  ASSERT_EQ(contents.chunks.size(), 2u);
  EXPECT_EQ(contents.chunks[0].chunk, (IVec3{0, 0, 0}));
  EXPECT_EQ(contents.chunks[1].island, 78u);
  EXPECT_FALSE(contents.islands[0].motion);
}

TEST(WorldFile, ATickBeyondAllTimeIsRefused) {
  const Folder folder;
  auto file = WorldFile::create(folder / "w", info_of_seed_4());
  ASSERT_TRUE(file);
  MotionState motion;
  motion.tick = std::int64_t{1} << 49;
  auto transaction = (*file)->begin();
  transaction.put_island({spec_of(77), true, motion});
  ASSERT_TRUE(transaction.commit());
  EXPECT_FALSE((*file)->read().islands.at(0).motion);
  EXPECT_EQ((*file)->damage().size(), 1u);
}

TEST(LoadWorld, AnotherGeneratorIsTold) {
  const Folder folder;
  auto file = WorldFile::create(folder / "w", info_of_seed_4());
  ASSERT_TRUE(file);
  load_world(**file);
  EXPECT_TRUE((*file)->damage().empty());
  const std::uint32_t version = kGeneratorVersion + 1;
  auto transaction = (*file)->begin();
  transaction.put_value("generator", std::as_bytes(std::span(&version, 1)));
  ASSERT_TRUE(transaction.commit());
  load_world(**file);
  ASSERT_EQ((*file)->damage().size(), 1u);
  EXPECT_NE((*file)->damage()[0].find("generator"), std::string::npos);
}

}  // namespace
}  // namespace skerry::world
