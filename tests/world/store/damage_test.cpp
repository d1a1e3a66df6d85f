// What becomes of world files whose bytes were flipped, torn or meddled with.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "tests/world/store/made_worlds.h"
#include "world/store/pages.h"
#include "world/store/schema.h"
#include "world/store/world_file.h"

namespace skerry::world {
namespace {

namespace fs = std::filesystem;
using Mode = WorldFile::Mode;

TEST(DamagedWorldFile, StrangeTablesAreLeftBehindAndTheRestIsRead) {
  const std::string one_bit_off =
      "PRAGMA application_id = " + std::to_string(kApplicationId ^ 0x1000);
  for (const char* sql : {"PRAGMA user_version = 0", "PRAGMA user_version = -1",
                          one_bit_off.c_str(), "CREATE VIEW v AS SELECT 1",
                          "CREATE TRIGGER t AFTER INSERT ON chunk BEGIN DELETE FROM value; END",
                          "DROP TABLE motion; CREATE VIEW motion AS SELECT * FROM island",
                          "DROP TABLE motion", "DELETE FROM value"}) {
    const Folder folder;
    const fs::path path = folder / "w";
    Rng rng(6);
    Given given;
    {
      auto file = WorldFile::create(path, info_of_seed_4());
      ASSERT_TRUE(file);
      given = fill(**file, rng, 3);
    }
    run_sql(path, sql);
    const std::string before = bytes_of(path);
    for (const Mode mode : {Mode::kRead, Mode::kWrite, Mode::kRead}) {
      auto file = WorldFile::open(path, mode);
      ASSERT_TRUE(file) << sql << ": " << file.error().message;
      EXPECT_EQ((*file)->info(), info_of_seed_4());
      EXPECT_EQ(expect_same(given, (*file)->read()), given.edits.size() + given.chunks.size());
      const bool mended = !fs::exists(folder / "w.damaged");
      if (mode == Mode::kRead && !mended) {
        EXPECT_TRUE((*file)->damage().empty()) << sql;
        continue;
      }
      EXPECT_FALSE((*file)->damage().empty()) << sql;
      if (mode == Mode::kRead || std::string_view(sql) == "DELETE FROM value") continue;
      EXPECT_EQ(bytes_of(folder / "w.damaged"), before) << sql;
      auto transaction = (*file)->begin();
      const ChunkName name{given.chunks.begin()->first.island, {9, 9, 9}};
      given.chunks.insert_or_assign(name, random_chunk(rng));
      transaction.put_chunk(name.island, name.chunk, given.chunks.at(name));
      ASSERT_TRUE(transaction.commit()) << sql;
      EXPECT_TRUE((*file)->value("info")) << "a trigger was at work";
    }
  }
}

TEST(DamagedWorldFile, ReadingOneLeavesTheFolderAsItWas) {
  const Folder folder;
  const fs::path path = folder / "w";
  Rng rng(9);
  {
    auto file = WorldFile::create(path, info_of_seed_4());
    ASSERT_TRUE(file);
    fill(**file, rng, 3);
  }
  run_sql(path, "DELETE FROM value");
  const std::string before = bytes_of(path);
  {
    auto file = WorldFile::open(path, Mode::kRead);
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_FALSE((*file)->damage().empty());
    (*file)->read();
  }
  EXPECT_EQ(bytes_of(path), before);
  for (const char* beside : {"w-wal", "w-shm", "w-journal", "w.damaged"})
    EXPECT_FALSE(fs::exists(folder / beside)) << beside;
}

/// Opens a damaged file as often as there are ways to, and looks whether anything is amiss that is
/// not told. @return how much of what it was given came back.
std::size_t read_damaged(const fs::path& path, const Given& given, std::size_t at) {
  auto file = WorldFile::open(path, Mode::kRead);
  EXPECT_TRUE(file) << at << ": " << file.error().message;
  if (!file) return 0;
  EXPECT_EQ((*file)->info(), info_of_seed_4());
  const auto play = (*file)->value("play");
  EXPECT_EQ(play ? play->size() : 5u, 5u);
  const WorldFile::Contents contents = (*file)->read();
  const std::size_t found = expect_same(given, contents);
  std::size_t motions = 0, expected_motions = 0;
  for (const IslandRow& row : contents.islands) {
    motions += row.motion && row.motion == given.islands.at(row.spec.id).motion;
    EXPECT_TRUE(!row.motion || row.motion == given.islands.at(row.spec.id).motion);
  }
  for (const auto& [id, row] : given.islands) expected_motions += row.motion.has_value();
  const bool all = found == given.edits.size() + given.chunks.size() && play &&
                   motions == expected_motions && contents.islands.size() == given.islands.size();
  EXPECT_TRUE(all || !(*file)->damage().empty()) << "lost in silence at " << at;
  for (const std::string& line : (*file)->damage()) EXPECT_EQ(line.find('\n'), std::string::npos);
  return found;
}

struct GoodFile {
  Folder folder;
  Given given;
  std::string bytes;

  explicit GoodFile(std::uint64_t seed, int islands) {
    Rng rng(seed);
    {
      auto file = WorldFile::create(folder / "good", info_of_seed_4());
      EXPECT_TRUE(file);
      given = fill(**file, rng, islands);
      auto transaction = (*file)->begin();
      transaction.put_value("play", std::as_bytes(std::span("here")));
      EXPECT_TRUE(transaction.commit());
    }
    bytes = bytes_of(folder / "good");
  }
  std::size_t all() const { return given.edits.size() + given.chunks.size(); }
  fs::path with(const std::string& bad) const {
    std::ofstream(folder / "bad", std::ios::binary) << bad;
    return folder / "bad";
  }
};

TEST(DamagedWorldFile, WithAnyPageTornTheRestIsRead) {
  const GoodFile good(11, 5);
  std::size_t read = 0;
  const std::size_t pages = good.bytes.size() / 4096;
  ASSERT_GT(pages, 20u);
  for (std::size_t page = 0; page < pages; ++page) {
    std::string bad = good.bytes;
    std::fill_n(bad.begin() + static_cast<std::ptrdiff_t>(4096 * page), 4096, '\0');
    const std::size_t found = read_damaged(good.with(bad), good.given, 4096 * page);
    read += found;
    EXPECT_GT(found + 12, good.all()) << "page " << page;  // what a page and its chains can hold
  }
  EXPECT_GT(static_cast<double>(read), 0.95 * static_cast<double>(good.all() * pages));
}

TEST(DamagedWorldFile, AnyFlippedBitIsToldAndTheRestIsRead) {
  const GoodFile good(12, 3);
  Rng rng(13);
  std::size_t read = 0, rounds = 0;
  const auto flip = [&](std::size_t bit) {
    std::string bad = good.bytes;
    bad[bit / 8] = static_cast<char>(bad[bit / 8] ^ 1 << bit % 8);
    // A version that is greater by a bit cannot be told from a newer program's.
    if (bit / 8 >= 60 && bit / 8 < 64 && (good.bytes[bit / 8] & 1 << bit % 8) == 0 && bit != 487)
      return expect_refused(good.with(bad), Mode::kRead, "newer Skerry");
    read += read_damaged(good.with(bad), good.given, bit / 8);
    ++rounds;
  };
  for (std::size_t bit = 0; bit < 100 * 8; bit += 11) flip(bit);  // what SQLite reads first
  // What heads each page and lists its rows, then anything.
  for (std::size_t page = 0; page < good.bytes.size() / 4096; ++page)
    for (int i = 0; i < 2; ++i)
      flip((4096 * page + static_cast<std::size_t>(rng.in(0, 31))) * 8 +
           static_cast<std::size_t>(rng.in(0, 7)));
  for (int i = 0; i < 60; ++i)
    flip(static_cast<std::size_t>(rng.in(0, static_cast<int>(good.bytes.size()) * 8 - 1)));
  EXPECT_GT(static_cast<double>(read), 0.98 * static_cast<double>(good.all() * rounds));
}

TEST(DamagedWorldFile, ADamagedFileIsWrittenAnewAndKept) {
  const GoodFile good(14, 5);
  for (const std::size_t page : {0, 1, 2, 3, 4, 5, 6, 7}) {
    std::string bad = good.bytes;
    std::fill_n(bad.begin() + static_cast<std::ptrdiff_t>(4096 * page), 4096, '\0');
    const fs::path path = good.with(bad);
    std::size_t found = 0;
    {
      auto file = WorldFile::open(path, Mode::kWrite);
      ASSERT_TRUE(file) << page << ": " << file.error().message;
      const std::vector<std::string>& told = (*file)->damage();
      EXPECT_TRUE(std::any_of(told.begin(), told.end(), [](const std::string& line) {
        return line.find("bad.damaged") != std::string::npos;
      })) << page;
      expect_refused(path, Mode::kWrite, "another Skerry has it open");
      auto transaction = (*file)->begin();
      transaction.put_value("play", std::as_bytes(std::span("there!")));
      ASSERT_TRUE(transaction.commit());
      found = expect_same(good.given, (*file)->read());
      EXPECT_GT(found, 0u);
    }
    auto file = WorldFile::open(path, Mode::kWrite);
    ASSERT_TRUE(file);
    EXPECT_EQ((*file)->value("play")->size(), 7u);
    EXPECT_EQ(expect_same(good.given, (*file)->read()), found);
    fs::path kept = good.folder / "bad.damaged";
    if (page > 0) (kept += "_") += std::to_string(page + 1);
    EXPECT_EQ(bytes_of(kept), bad);
  }
}

TEST(DamagedWorldFile, WhatWasCommittedToTheLogIsFoundInADamagedFile) {
  const GoodFile good(15, 4);
  const fs::path path = good.folder / "copy";
  Given given = good.given;
  {
    fs::copy_file(good.folder / "good", good.folder / "w");
    auto file = WorldFile::open(good.folder / "w", Mode::kWrite);
    ASSERT_TRUE(file);
    const HeldReader reader(good.folder / "w");
    Rng rng(16);
    for (int i = 0; i < 2; ++i) {
      auto transaction = (*file)->begin();
      for (auto& [name, edits] : given.edits) {
        edits = random_edits(rng, 700);
        transaction.put_edits(name.island, name.chunk, edits);
      }
      ASSERT_TRUE(transaction.commit());
    }
    // As if it had been killed now.
    fs::copy_file(good.folder / "w", path);
    fs::copy_file(good.folder / "w-wal", good.folder / "copy-wal");
  }
  {
    std::fstream main(path, std::ios::binary | std::ios::in | std::ios::out);
    main.write(std::string(4096, 'x').data(), 4096);
  }
  auto file = WorldFile::open(path, Mode::kRead);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(expect_same(given, (*file)->read()), good.all());
}

TEST(DamagedWorldFile, WhatWasTakenBackIsNotFoundInADamagedFile) {
  const Folder folder;
  const fs::path path = folder / "w";
  Rng rng(17);
  {
    auto file = WorldFile::create(path, info_of_seed_4());
    ASSERT_TRUE(file);
    for (const bool gone : {false, true}) {
      auto transaction = (*file)->begin();
      transaction.put_island({spec_of(9)});
      for (int i = 0; i < 40; ++i)
        transaction.put_edits(9, {i, 0, 0}, gone ? ChunkEdits{} : random_edits(rng, 900));
      ASSERT_TRUE(transaction.commit());
    }
  }
  std::fstream(path, std::ios::binary | std::ios::in | std::ios::out)
      .write(std::string(4096, '\0').data(), 4096);
  auto file = WorldFile::open(path, Mode::kRead);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_TRUE((*file)->read().edits.empty());
}

TEST(DamagedWorldFile, OneThatNobodyCanNameStaysAsItIs) {
  const GoodFile good(15, 2);
  run_sql(good.folder / "good", "DELETE FROM value; DELETE FROM spare");
  const std::string before = bytes_of(good.folder / "good");
  for (const Mode mode : {Mode::kWrite, Mode::kRead, Mode::kWrite})
    EXPECT_FALSE(WorldFile::open(good.folder / "good", mode));
  EXPECT_EQ(bytes_of(good.folder / "good"), before);
  EXPECT_FALSE(fs::exists(good.folder / "good.damaged"));
}

TEST(DamagedWorldFile, BehindALinkIsMendedWhereItIs) {
  const GoodFile good(16, 2);
  std::string bad = good.bytes;
  std::fill_n(bad.begin(), 4096, '\0');
  const fs::path path = good.with(bad), link = good.folder / "link";
  fs::create_symlink(path, link);
  EXPECT_TRUE(WorldFile::open(link, Mode::kWrite));
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(bytes_of(good.folder / "bad.damaged"), bad);
  EXPECT_EQ(read_damaged(path, good.given, 0), good.all());
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

TEST(DamagedWorldFile, WhatAKilledRecoveryLeftGoesWithTheNext) {
  const GoodFile good(18, 8);
  std::string bad = good.bytes;
  std::fill_n(bad.begin(), 4096, '\0');
  const fs::path path = good.with(bad);
  const std::set<std::string> before = names_in(good.folder.path());
  const pid_t child = ::fork();
  if (child == 0) {
    // The first write beyond so many bytes of a file kills it.
    const rlimit two_pages{8192, 8192};
    ::setrlimit(RLIMIT_FSIZE, &two_pages);
    const auto file = WorldFile::open(path, Mode::kWrite);
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status)) << status;
  ASSERT_EQ(bytes_of(path), bad);
  ASSERT_NE(names_in(good.folder.path()), before) << "killed too early to leave anything";
  std::set<std::string> after = before;
  after.insert("bad.damaged");
  EXPECT_TRUE(WorldFile::open(path, Mode::kWrite));
  EXPECT_EQ(names_in(good.folder.path()), after);
}

/// A log of one frame that says how many pages there are, with sound checksums
/// (https://www.sqlite.org/fileformat2.html#wal_file_format).
std::string log_that_says(std::uint32_t pages) {
  const auto word = [](std::uint32_t value) {
    std::string out;
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 255);
    return out;
  };
  std::uint32_t a = 0, b = 0;
  const auto add = [&](const std::string& bytes) {
    const auto at = [&](std::size_t i) {  // words in the order of the bytes: magic ...83
      std::uint32_t value = 0;
      for (std::size_t k = 0; k < 4; ++k)
        value = value << 8 | static_cast<unsigned char>(bytes[i + k]);
      return value;
    };
    for (std::size_t i = 0; i < bytes.size(); i += 8) {
      a += at(i) + b;
      b += at(i + 4) + a;
    }
  };
  std::string log = word(0x377f0683) + word(3007000) + word(4096) + word(0) + word(1) + word(2);
  add(log);
  log += word(a) + word(b);
  const std::string frame = word(2) + word(pages), page(4096, '\0');
  add(frame);
  add(page);
  return log + frame + word(1) + word(2) + word(a) + word(b) + page;
}

TEST(DamagedWorldFile, ALogThatBoastsOfPagesIsNotBelieved) {
  const Folder folder;
  std::ofstream(folder / "w", std::ios::binary) << std::string(3 * 4096, 'x');
  for (const auto& [says, expected] : {std::pair{2u, 2u}, {3u, 3u}, {4'000'000'000u, 3u}}) {
    std::ofstream(folder / "w-wal", std::ios::binary) << log_that_says(says);
    EXPECT_EQ(PageFile(folder / "w").count(), expected);
  }
}

}  // namespace
}  // namespace skerry::world
