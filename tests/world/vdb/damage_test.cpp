// Some hundred damaged files of thousands. All of them, minutes of two cores:
//   SKERRY_VDB_MUTANTS=9999 skerry_tests --gtest_filter='VdbDamage.*'
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <mutex>

#include "engine/core/clock.h"
#include "tests/world/vdb/sample_files.h"
#include "world/vdb_import/import.h"
#include "world/voxel/hash.h"

namespace skerry::world {
namespace {

constexpr std::size_t kLeastMutants = 2000, kUsualMutants = 300;
const ReadLimits kLimits{std::uint64_t{1} << 30, std::uint64_t{1} << 26, 2, 10.0};

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

struct Mutant {
  std::string bytes;
  bool truncated = false;
};

/// Truncations at every kilobyte, then so many files with some bits flipped.
std::vector<Mutant> mutants_of(const std::string& whole, int flips, std::uint64_t seed) {
  std::vector<Mutant> out;
  for (std::size_t size = 0; size < whole.size(); size += 1024)
    out.push_back({whole.substr(0, size), true});
  Rng random(seed);
  for (int i = 0; i < flips; ++i) {
    Mutant mutant{whole};
    for (int bit = random.in(1, 8); bit > 0; --bit) {
      // Headers and topology are a small part of a file and the more dangerous one.
      const int last = static_cast<int>(whole.size()) - 1;
      const int at = random.in(0, random.chance(128) ? std::min(last, 4096) : last);
      mutant.bytes[static_cast<std::size_t>(at)] ^= static_cast<char>(1 << random.in(0, 7));
    }
    out.push_back(std::move(mutant));
  }
  return out;
}

struct Tally {
  std::atomic<int> refused = 0, read = 0, truncated_read = 0;
  std::atomic<int> longest_ms = 0;
  std::mutex mutex;
  std::map<std::string, int> reasons;
};

void try_mutant(const Mutant& mutant, const std::filesystem::path& path, Jobs& one, Tally& tally) {
  std::ofstream(path, std::ios::binary) << mutant.bytes;
  const Stopwatch watch;
  const auto grids = read_vdb(path, kLimits);
  const int took = static_cast<int>(watch.milliseconds());
  for (int longest = tally.longest_ms; took > longest;)
    if (tally.longest_ms.compare_exchange_weak(longest, took)) break;
  std::filesystem::remove(path);
  if (!grids) {
    ++tally.refused;
    const std::string& line = grids.error().message;
    EXPECT_EQ(line.find('\n'), std::string::npos);
    const std::lock_guard lock(tally.mutex);
    ++tally.reasons[line.substr(std::min(line.size(), line.find("': ") + 3), 40)];
    return;
  }
  ++tally.read;
  if (mutant.truncated) ++tally.truncated_read;
  // What was let through must go all the way, or be refused on it.
  const auto islands = import_islands(*grids, {.size_blocks = 64}, one);
  EXPECT_TRUE(static_cast<bool>(islands) || !islands.error().message.empty());
}

TEST(VdbDamage, NoDamagedFileHurtsTheProgram) {
  SKIP_WITHOUT_OPENVDB();
  const char* wanted = std::getenv("SKERRY_VDB_MUTANTS");
  std::vector<Mutant> all;
  for (const char* name : {"ball.vdb", "cloud.vdb", "types.vdb", "transforms.vdb", "huge.vdb"}) {
    for (Mutant& mutant : mutants_of(content_of(sample_files() / name), 320, all.size() + 1))
      all.push_back(std::move(mutant));
  }
  ASSERT_GE(all.size(), kLeastMutants);
  const std::size_t limit = wanted ? static_cast<std::size_t>(std::atoi(wanted)) : kUsualMutants;
  // A short run takes every n-th, so that it has some of each kind.
  const std::size_t step = std::max<std::size_t>(1, all.size() / std::max<std::size_t>(1, limit));
  const Folder folder;
  Tally tally;
  Jobs jobs;
  const int count = static_cast<int>((all.size() + step - 1) / step);
  jobs.parallel_for(count, [&](int i) {
    Jobs one(1);
    const auto at = static_cast<std::size_t>(i) * step;
    try_mutant(all[at], folder / std::to_string(at), one, tally);
  });
  EXPECT_EQ(tally.refused + tally.read, count);
  EXPECT_EQ(tally.truncated_read, 0) << "a truncated file passed for a whole one";
  EXPECT_LT(tally.longest_ms, 11'000);
  std::printf("%d mutants: %d refused, %d read; the slowest took %d ms\n", count,
              tally.refused.load(), tally.read.load(), tally.longest_ms.load());
  for (const auto& [reason, times] : tally.reasons) std::printf("%6d %s\n", times, reason.c_str());
}

}  // namespace
}  // namespace skerry::world
