// A process that saves is killed at any moment; then the file must hold all that was committed, and
// nothing by halves. SKERRY_KILL_ROUNDS=1000 makes it the long run of docs/saving.md.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "tests/world/store/made_worlds.h"
#include "world/store/bytes.h"

namespace skerry::world {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kChunks = 12, kIsland = 9;

/// What commit number n writes; it decides where, too.
ChunkEdits edits_of_commit(std::uint64_t n) {
  Rng rng(n);
  return random_edits(rng, 300);
}
IVec3 chunk_of_commit(std::uint64_t n) {
  return {static_cast<std::int32_t>(n % kChunks), 0, 0};
}

/// Commits 'first', 'first' + 1, ... and says so after each.
[[noreturn]] void edit_for_ever(const fs::path& path, std::uint64_t first, int told) {
  auto file = WorldFile::open(path, WorldFile::Mode::kWrite);
  if (!file) ::_exit(1);
  for (std::uint64_t n = first;; ++n) {
    auto transaction = (*file)->begin();
    transaction.put_edits(kIsland, chunk_of_commit(n), edits_of_commit(n));
    ByteWriter count;
    count.u64(n);
    transaction.put_value("count", count.bytes());
    if (!transaction.commit()) ::_exit(1);
    if (::write(told, &n, sizeof n) != sizeof n) ::_exit(1);
  }
}

/// The number of the last commit that is in a file; 0: none. Everything in it must be of that.
std::uint64_t check(const fs::path& path) {
  auto file = WorldFile::open(path, WorldFile::Mode::kRead);
  if (!file) {
    ADD_FAILURE() << "unreadable: " << file.error().message;
    return 0;
  }
  const auto bytes = (*file)->value("count");
  const std::uint64_t last = bytes ? ByteReader(*bytes).u64() : 0;
  const WorldFile::Contents contents = (*file)->read();
  EXPECT_TRUE((*file)->damage().empty());
  EXPECT_EQ(contents.edits.size(), std::min(last, kChunks));
  for (const auto& edits : contents.edits) {
    // The last commit up to `last` that wrote there.
    std::uint64_t n = last;
    while (n > 0 && chunk_of_commit(n) != edits.chunk) --n;
    EXPECT_EQ(edits.edits, edits_of_commit(n)) << "commit " << n << " of " << last;
  }
  return last;
}

TEST(KillTest, WhatWasCommittedOutlivesTheProcess) {
  const char* asked = std::getenv("SKERRY_KILL_ROUNDS");
  const int rounds = asked ? std::atoi(asked) : 20;
  const Folder folder;
  const fs::path path = folder / "w";
  {
    auto file = WorldFile::create(path, info_of_seed_4());
    ASSERT_TRUE(file);
    auto transaction = (*file)->begin();
    transaction.put_island({spec_of(kIsland)});
    ASSERT_TRUE(transaction.commit());
  }
  Rng rng(static_cast<std::uint64_t>(::getpid()));
  std::uint64_t last = 0, before_kill = 0;
  for (int round = 0; round < rounds; ++round) {
    int told[2];
    ASSERT_EQ(::pipe(told), 0);
    const pid_t child = ::fork();
    if (child == 0) edit_for_ever(path, last + 1, told[1]);
    ::close(told[1]);
    std::uint64_t committed = last;
    // Every other one is killed after its first commit, however long that takes here, the others
    // whatever they are at.
    if (round % 2 == 1 && ::read(told[0], &before_kill, sizeof before_kill) == sizeof before_kill)
      committed = before_kill;
    std::this_thread::sleep_for(std::chrono::microseconds(rng.in(0, 200'000)));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    while (::read(told[0], &before_kill, sizeof before_kill) == sizeof before_kill)
      committed = before_kill;
    ::close(told[0]);
    last = check(path);
    ASSERT_GE(last, committed) << "a committed edit is lost";
    ASSERT_LE(last, committed + 1);
    if (HasFailure()) break;
  }
  EXPECT_GT(last, static_cast<std::uint64_t>(rounds) / 4) << "killed before anything was done";
  RecordProperty("commits", static_cast<int>(last));
}

}  // namespace
}  // namespace skerry::world
