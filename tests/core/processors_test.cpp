#include "engine/core/processors.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <thread>

namespace skerry {
namespace {

TEST(UsableCpus, AreThoseOfTheAffinity) {
  cpu_set_t all;
  ASSERT_EQ(::sched_getaffinity(0, sizeof all, &all), 0);
  // Affinity is a thread's own.
  std::thread([&] {
    cpu_set_t some;
    CPU_ZERO(&some);
    for (int cpu = 0, count = 0; cpu < CPU_SETSIZE; ++cpu) {
      if (!CPU_ISSET(cpu, &all)) continue;
      CPU_SET(cpu, &some);
      ASSERT_EQ(::sched_setaffinity(0, sizeof some, &some), 0);
      EXPECT_EQ(usable_cpus(), ++count);
    }
  }).join();
  EXPECT_EQ(usable_cpus(), CPU_COUNT(&all));
}

}  // namespace
}  // namespace skerry
