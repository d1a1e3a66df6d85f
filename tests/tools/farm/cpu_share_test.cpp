#include "tools/skerry/farm/cpu_share.h"

#include <gtest/gtest.h>
#include <hwloc.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <memory>
#include <set>

namespace skerry::tools {
namespace {

using Parts = std::vector<std::vector<unsigned>>;

Parts parts_of(const char* machine, std::size_t shares) {
  hwloc_topology_t topology = nullptr;
  EXPECT_EQ(hwloc_topology_init(&topology), 0);
  EXPECT_EQ(hwloc_topology_set_synthetic(topology, machine), 0) << machine;
  EXPECT_EQ(hwloc_topology_load(topology), 0);
  Parts parts = cpu_shares(topology, shares);
  hwloc_topology_destroy(topology);
  return parts;
}

std::set<unsigned> all_of(const Parts& parts) {
  std::set<unsigned> all;
  for (const auto& part : parts) all.insert(part.begin(), part.end());
  return all;
}

TEST(CpuShares, KeepCoresAndCachesWhole) {
  // Two threads a core, numbered as Linux does: the second ones after all first ones.
  const char* const machine = "pack:2 l3:2 core:4 pu:2(indexes=2*16:1*2)";
  EXPECT_EQ(parts_of(machine, 4), (Parts{{0, 1, 2, 3, 16, 17, 18, 19},
                                         {4, 5, 6, 7, 20, 21, 22, 23},
                                         {8, 9, 10, 11, 24, 25, 26, 27},
                                         {12, 13, 14, 15, 28, 29, 30, 31}}));
  EXPECT_EQ(parts_of(machine, 32).size(), 32u);
}

TEST(CpuShares, AreDisjointAndLeaveNothingOut) {
  for (const char* const machine : {"pu:7", "pack:2 core:3 pu:2", "pack:3 l3:2 core:2 pu:1"}) {
    const std::size_t cpus = all_of(parts_of(machine, 1)).size();
    for (std::size_t shares = 1; shares <= cpus; ++shares) {
      const Parts parts = parts_of(machine, shares);
      ASSERT_EQ(parts.size(), shares) << machine;
      std::size_t held = 0, least = cpus;
      for (const auto& part : parts) held += part.size(), least = std::min(least, part.size());
      EXPECT_EQ(held, cpus) << machine << " " << shares;
      EXPECT_EQ(all_of(parts).size(), cpus) << machine << " " << shares;
      EXPECT_GE(least, 1u);
    }
    EXPECT_TRUE(parts_of(machine, cpus + 1).empty()) << machine;
  }
}

/// The processors that a process of its own may use once `body` has run in it.
template <class Body>
std::set<int> cpus_after(const Body& body) {
  int ends[2];
  EXPECT_EQ(::pipe(ends), 0);
  const pid_t process = ::fork();
  if (process == 0) {
    body();
    cpu_set_t set;
    const bool told = ::sched_getaffinity(0, sizeof set, &set) == 0 &&
                      ::write(ends[1], &set, sizeof set) == sizeof set;
    ::_exit(told ? 0 : 1);
  }
  ::close(ends[1]);
  cpu_set_t set;
  CPU_ZERO(&set);
  EXPECT_EQ(::read(ends[0], &set, sizeof set), static_cast<ssize_t>(sizeof set));
  ::close(ends[0]);
  ::waitpid(process, nullptr, 0);
  std::set<int> cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
    if (CPU_ISSET(cpu, &set)) cpus.insert(cpu);
  return cpus;
}

TEST(StayOnCpuShare, GivesEachProcessProcessorsOfItsOwn) {
  const std::set<int> all = cpus_after([] {});
  const std::size_t shares = all.size();
  std::set<int> together;
  for (std::size_t share = 0; share < shares; ++share) {
    const std::set<int> own = cpus_after([&] { stay_on_cpu_share(share, shares); });
    EXPECT_EQ(own.size(), 1u);
    together.insert(own.begin(), own.end());
  }
  EXPECT_EQ(together, all);
  EXPECT_EQ(cpus_after([&] { stay_on_cpu_share(0, shares + 1); }), all) << "too few processors";
  EXPECT_EQ(cpus_after([] { stay_on_cpu_share(0, 1); }), all);
}

TEST(StayOnCpuShare, DividesWhatTheProcessMayUseAndNoMore) {
  const std::set<int> all = cpus_after([] {});
  const int last = *all.rbegin();
  const auto on_last = [&] {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(last, &set);
    ::sched_setaffinity(0, sizeof set, &set);
  };
  EXPECT_EQ(cpus_after([&] { on_last(), stay_on_cpu_share(1, 2); }), std::set{last});
}

}  // namespace
}  // namespace skerry::tools
