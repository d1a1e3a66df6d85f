#include "world/store/world_file.h"

#include <sqlite3.h>
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

void run_sql(const fs::path& path, const std::string& sql) {
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(db);
  sqlite3_close(db);
}

void expect_refused(const fs::path& path, Mode mode, std::string_view why) {
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
Given fill(WorldFile& file, Rng& rng, int islands) {
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

std::size_t expect_same(const Given& given, const WorldFile::Contents& contents) {
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
  std::ofstream(folder / "empty");
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

TEST(WorldFile, ANewerVersionAndStrangeTablesAreRefused) {
  const Folder folder;
  for (const auto& [sql, why] : std::initializer_list<std::pair<const char*, const char*>>{
           {"PRAGMA user_version = 3", "newer Skerry"},
           {"PRAGMA user_version = 0", "damaged"},
           {"PRAGMA user_version = -1", "damaged"},
           {"CREATE VIEW v AS SELECT 1", "damaged"},
           {"CREATE TRIGGER t AFTER INSERT ON chunk BEGIN DELETE FROM value; END", "damaged"},
           {"DROP TABLE chunk; CREATE VIEW chunk AS SELECT * FROM island", "damaged"},
           {"DROP TABLE motion", "damaged"},
           {"DELETE FROM value", "damaged"}}) {
    const fs::path path = folder / "w";
    fs::remove(path);
    ASSERT_TRUE(WorldFile::create(path, info_of_seed_4()));
    run_sql(path, sql);
    for (const Mode mode : {Mode::kRead, Mode::kWrite}) expect_refused(path, mode, why);
  }
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
  run_sql(path, "DROP TABLE motion; PRAGMA user_version = 1");
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

TEST(WorldFile, FlippedAndTornBytesAreToldAndTheRestIsRead) {
  const Folder folder;
  Rng rng(11);
  Given given;
  {
    auto file = WorldFile::create(folder / "good", info_of_seed_4());
    ASSERT_TRUE(file);
    given = fill(**file, rng, 8);
  }
  std::ifstream in(folder / "good", std::ios::binary);
  const std::string good{std::istreambuf_iterator<char>(in), {}};
  const std::size_t all = given.edits.size() + given.chunks.size();
  constexpr int kRounds = 90;
  int unreadable = 0;
  std::size_t read = 0;
  for (int round = 0; round < kRounds; ++round) {
    std::string bad = good;
    const auto at = static_cast<std::size_t>(rng.in(0, static_cast<int>(bad.size()) - 1));
    if (round % 3 == 2) {
      // A page that was never written.
      const std::size_t page = at / 4096 * 4096;
      std::fill_n(bad.begin() + static_cast<std::ptrdiff_t>(page), 4096, '\0');
    } else {
      bad[at] = static_cast<char>(bad[at] ^ 1 << rng.in(0, 7));
    }
    const fs::path path = folder / "bad";
    std::ofstream(path, std::ios::binary) << bad;
    auto file = WorldFile::open(path, Mode::kRead);
    if (!file) {
      ++unreadable;
      continue;
    }
    const std::size_t found = expect_same(given, (*file)->read());
    read += found;
    EXPECT_TRUE(found == all || !(*file)->damage().empty()) << "lost in silence at " << at;
    for (const std::string& line : (*file)->damage()) EXPECT_EQ(line.find('\n'), std::string::npos);
  }
  // The first page, the tables' roots and the info take the whole file along.
  EXPECT_LT(unreadable, kRounds / 10);
  EXPECT_GT(static_cast<double>(read), 0.95 * static_cast<double>(all) * (kRounds - unreadable));
  ::testing::Test::RecordProperty("unreadable", unreadable);
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
    auto transaction = (*file)->begin();
    transaction.put_island({spec_of(77), true});
    ASSERT_TRUE(transaction.commit());
    fs::copy_file(log, aside);
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
