// Any one bit of a world's file or of its log is flipped, at rest and as kills leave them: what was
// saved is read, or the damage is told. SKERRY_FLIPS=4000 makes it the long run of docs/saving.md.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "tests/world/store/made_worlds.h"

namespace skerry::world {
namespace {

namespace fs = std::filesystem;
using Mode = WorldFile::Mode;

constexpr std::size_t kPage = 4096, kLogHeader = 32, kFrameHeader = 24;
constexpr std::size_t kFrame = kFrameHeader + kPage;

/// A state of a world that was saved.
struct Save {
  Given given;
  std::string play;
  std::size_t all() const { return given.edits.size() + given.chunks.size(); }
};

/// What a kill leaves: a file, its log, and the saves of which one must be read without a word.
struct Left {
  std::string name, file, log;
  std::vector<const Save*> sound;
};

/// Changes some chunks, takes some back, brings new ones.
void change(WorldFile& file, Rng& rng, Save& save) {
  auto transaction = file.begin();
  std::size_t count = 0;
  for (auto& [name, edits] : save.given.edits) {
    if (++count % 3 == 0) continue;
    edits = random_edits(rng, 500);
    transaction.put_edits(name.island, name.chunk, edits);
  }
  for (auto& [name, chunk] : save.given.chunks) {
    if (++count % 2 == 0) continue;
    chunk = random_chunk(rng);
    transaction.put_chunk(name.island, name.chunk, chunk);
  }
  const std::uint64_t island = save.given.chunks.begin()->first.island;
  for (int i = 0; i < 2; ++i) {
    const ChunkName name{island, {rng.in(3, 9), rng.in(3, 9), rng.in(3, 9)}};
    save.given.chunks.insert_or_assign(name, random_chunk(rng));
    transaction.put_chunk(name.island, name.chunk, save.given.chunks.at(name));
  }
  save.play += "and on";
  transaction.put_value("play", std::as_bytes(std::span(save.play)));
  EXPECT_TRUE(transaction.commit());
}

std::uint32_t page_of_frame(const std::string& log, std::size_t frame) {
  std::uint32_t page = 0;
  for (std::size_t i = 0; i < 4; ++i)
    page = page << 8 | static_cast<unsigned char>(log[kLogHeader + frame * kFrame + i]);
  return page;
}

/// A file into which the first `pages` pages of its log have been brought, ascending.
std::string partly_copied(std::string file, const std::string& log, std::size_t pages) {
  std::map<std::uint32_t, std::size_t> last;
  for (std::size_t frame = 0; kLogHeader + (frame + 1) * kFrame <= log.size(); ++frame)
    last[page_of_frame(log, frame)] = frame;
  for (const auto& [page, frame] : last) {
    if (pages-- == 0) break;
    file.resize(std::max(file.size(), page * kPage), '\0');
    file.replace((page - 1) * kPage, kPage, log, kLogHeader + frame * kFrame + kFrameHeader, kPage);
  }
  return file;
}

struct Story {
  Folder folder;
  Save saves[3];
  std::vector<Left> left;

  Story() {
    const fs::path path = folder / "story";
    Rng rng(21);
    auto file = WorldFile::create(path, info_of_seed_4());
    EXPECT_TRUE(file);
    saves[0].given = fill(**file, rng, 4);
    change(**file, rng, saves[0]);
    const std::string at_rest = bytes_of(path);
    const HeldReader reader(path);
    saves[1] = saves[0];
    change(**file, rng, saves[1]);
    const std::string file_1 = bytes_of(path), log_1 = bytes_of(path.string() + "-wal");
    saves[2] = saves[1];
    change(**file, rng, saves[2]);
    const std::string file_2 = bytes_of(path), log_2 = bytes_of(path.string() + "-wal");
    EXPECT_GT(log_1.size(), kLogHeader + 5 * kFrame);
    EXPECT_GT(log_2.size(), log_1.size());
    const std::size_t frames = (log_1.size() - kLogHeader) / kFrame;
    EXPECT_EQ(page_of_frame(log_1, frames - 1), 1u) << "the mark";
    left = {{"at rest", at_rest, "", {&saves[0]}},
            {"committed", file_1, log_1, {&saves[1]}},
            {"committed twice", file_2, log_2, {&saves[2]}},
            {"killed before the mark",
             file_1,
             log_1.substr(0, log_1.size() - kFrame),
             {&saves[0], &saves[1]}},
            {"killed amid a frame",
             file_1,
             log_1.substr(0, kLogHeader + frames / 2 * kFrame + 1000),
             {&saves[0]}}};
    for (const std::size_t pages : {std::size_t{1}, frames / 3, frames - 2})
      left.push_back({"killed while the log was copied",
                      partly_copied(file_1, log_1, pages),
                      log_1,
                      {&saves[1]}});
  }

  fs::path put(const Left& bad) const {
    for (const auto& entry : fs::directory_iterator(folder.path()))
      if (entry.path().filename().string().starts_with("bad")) fs::remove(entry.path());
    std::ofstream(folder / "bad", std::ios::binary) << bad.file;
    std::ofstream(folder / "bad-wal", std::ios::binary) << bad.log;
    return folder / "bad";
  }
};

bool is(const Save& save, WorldFile& file, const WorldFile::Contents& contents) {
  const auto play = file.value("play");
  const auto expected = std::as_bytes(std::span(save.play));
  if (!play || !std::ranges::equal(*play, expected) || !(file.info() == info_of_seed_4()) ||
      contents.edits.size() + contents.chunks.size() != save.all() ||
      contents.islands.size() != save.given.islands.size())
    return false;
  for (const IslandRow& row : contents.islands) {
    const auto found = save.given.islands.find(row.spec.id);
    if (found == save.given.islands.end() || found->second.motion != row.motion ||
        found->second.added != row.added || found->second.spec.origin != row.spec.origin)
      return false;
  }
  for (const auto& e : contents.edits) {
    const auto found = save.given.edits.find({e.island, e.chunk});
    if (found == save.given.edits.end() || found->second != e.edits) return false;
  }
  for (const auto& c : contents.chunks) {
    const auto found = save.given.chunks.find({c.island, c.chunk});
    if (found == save.given.chunks.end() || blocks_of(found->second) != blocks_of(c.voxels))
      return false;
  }
  return true;
}

/// How many chunks are as some save has them. All must be.
std::size_t known_chunks(const Story& story, const WorldFile::Contents& contents) {
  std::size_t known = 0;
  for (const auto& e : contents.edits)
    known += std::ranges::any_of(story.saves, [&](const Save& save) {
      const auto found = save.given.edits.find({e.island, e.chunk});
      return found != save.given.edits.end() && found->second == e.edits;
    });
  for (const auto& c : contents.chunks)
    known += std::ranges::any_of(story.saves, [&](const Save& save) {
      const auto found = save.given.chunks.find({c.island, c.chunk});
      return found != save.given.chunks.end() && blocks_of(found->second) == blocks_of(c.voxels);
    });
  EXPECT_EQ(known, contents.edits.size() + contents.chunks.size()) << "made up";
  return known;
}

struct Tally {
  std::size_t flips = 0, harmless = 0, told = 0, refused = 0, silent = 0;
  double found = 0.0, of = 0.0;  // chunks of what was told
};

void open_flipped(const Story& story, const Left& bad, Mode mode, Tally& tally) {
  ++tally.flips;
  auto file = WorldFile::open(story.put(bad), mode);
  if (!file) {
    ++tally.refused;
    EXPECT_EQ(file.error().message.find('\n'), std::string::npos);
    return;
  }
  const WorldFile::Contents contents = (*file)->read();
  const bool sound =
      std::ranges::any_of(bad.sound, [&](const Save* save) { return is(*save, **file, contents); });
  const std::size_t found = known_chunks(story, contents);
  const bool told = !(*file)->damage().empty();
  tally.harmless += sound && !told;
  tally.told += told;
  tally.silent += !sound && !told;
  if (!told) return;
  const std::size_t all = bad.sound.front()->all();
  tally.found += static_cast<double>(std::min(found, all));
  tally.of += static_cast<double>(all);
  EXPECT_GT(found + 12, all) << "lost more than a page can hold";
  if (mode == Mode::kRead || !fs::exists(story.folder / "bad.damaged")) return;
  EXPECT_EQ(bytes_of(story.folder / "bad.damaged"), bad.file);
  EXPECT_EQ(bytes_of(story.folder / "bad.damaged-wal"), bad.log);
}

TEST(FlippedBit, OfFileOrLogIsToldOrHarmless) {
  const char* asked = std::getenv("SKERRY_FLIPS");
  const auto most = static_cast<std::size_t>(asked ? std::atoi(asked) : 200);
  const Story story;
  for (const Left& left : story.left) {  // as it was left, it is sound
    Tally none;
    open_flipped(story, left, Mode::kRead, none);
    EXPECT_EQ(none.harmless, 1u) << left.name;
  }
  // Parts of which each gets as many flips: the log's header, its frames, the file's pages.
  struct Part {
    const Left* left;
    bool of_log;
    std::size_t at, bytes;
  };
  std::vector<Part> parts;
  for (const Left& left : story.left) {
    for (std::size_t at = 0; at < left.file.size(); at += kPage)
      parts.push_back({&left, false, at, kPage});
    if (!left.log.empty()) parts.push_back({&left, true, 0, kLogHeader});
    for (std::size_t at = kLogHeader; at + kFrameHeader <= left.log.size(); at += kFrame)
      parts.push_back({&left, true, at, std::min(kFrame, left.log.size() - at)});
  }
  if (asked) {
    EXPECT_GE(most, parts.size()) << "not every page gets one";
  }
  Rng rng(22);
  Tally tally;
  for (std::size_t i = 0; i < most; ++i) {
    // Beginning anywhere, in steps that visit all parts before one comes again.
    const Part& part = parts[i * 7919 % parts.size()];
    // Every other one in what heads a page or a frame, where most is decided.
    const std::size_t within =
        i / parts.size() % 2 == i % 2 ? std::min<std::size_t>(32, part.bytes) : part.bytes;
    const std::size_t at =
        part.at + static_cast<std::size_t>(rng.in(0, static_cast<int>(within) - 1));
    const int bit = rng.in(0, 7);
    Left bad = *part.left;
    char& byte = (part.of_log ? bad.log : bad.file)[at];
    byte = static_cast<char>(byte ^ 1 << bit);
    const std::size_t silent = tally.silent;
    open_flipped(story, bad, i % 8 == 0 ? Mode::kWrite : Mode::kRead, tally);
    EXPECT_EQ(tally.silent, silent) << bad.name << ": bit " << bit << " of byte " << at
                                    << " of the " << (part.of_log ? "log" : "file");
  }
  std::printf(
      "%zu flips over %zu pages and frames: harmless %zu, told %zu, refused %zu, silent %zu; "
      "of what was told %.2f%% of the chunks were found\n",
      tally.flips, parts.size(), tally.harmless, tally.told, tally.refused, tally.silent,
      100.0 * tally.found / std::max(tally.of, 1.0));
  EXPECT_EQ(tally.silent, 0u);
  EXPECT_GT(tally.told, most / 10);
  EXPECT_LT(tally.refused, most / 100) << "only what looks newer is refused";
}

TEST(Log, IsEmptyOnceASaveIsDone) {
  const Folder folder;
  Rng rng(23);
  auto file = WorldFile::create(folder / "w", info_of_seed_4());
  ASSERT_TRUE(file);
  fill(**file, rng, 2);
  EXPECT_TRUE(bytes_of(folder / "w-wal").empty());
}

TEST(Log, OfANewerVersionIsLeftAsItIs) {
  const Folder folder;
  const fs::path path = folder / "w";
  Rng rng(24);
  std::string file_bytes, log_bytes;
  {
    auto file = WorldFile::create(path, info_of_seed_4());
    ASSERT_TRUE(file);
    fill(**file, rng, 2);
    *file = nullptr;
    // As if a newer program had been killed before its first save left the log.
    const HeldReader reader(path);
    run_sql(path, "PRAGMA wal_autocheckpoint = 0; PRAGMA user_version = 4");
    file_bytes = bytes_of(path);
    log_bytes = bytes_of(path.string() + "-wal");
  }
  ASSERT_GE(log_bytes.size(), kLogHeader + kFrame);
  for (const Mode mode : {Mode::kWrite, Mode::kRead}) {
    std::ofstream(path, std::ios::binary) << file_bytes;
    std::ofstream(path.string() + "-wal", std::ios::binary) << log_bytes;
    expect_refused(path, mode, "newer Skerry");
    EXPECT_EQ(bytes_of(path), file_bytes);
    EXPECT_EQ(bytes_of(path.string() + "-wal"), log_bytes);
  }
}

}  // namespace
}  // namespace skerry::world
