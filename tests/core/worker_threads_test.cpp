#include "engine/core/worker_threads.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <latch>
#include <string>
#include <vector>

namespace skerry {
namespace {

TEST(WorkerThreads, WaitCoversJobsThatJobsSubmit) {
  for (const int threads : {1, 2, 8}) {
    WorkerThreads background(threads);
    std::atomic<int> done = 0;
    const std::function<void(int)> split = [&](int depth) {
      if (depth > 0) {
        background.submit([&split, depth] { split(depth - 1); });
        background.submit([&split, depth] { split(depth - 1); });
      }
      ++done;
    };
    background.submit([&] { split(8); });
    background.wait();
    EXPECT_EQ(done, (1 << 9) - 1);
  }
}

TEST(WorkerThreads, AsManyAsAskedForWorkAtOnce) {
  WorkerThreads background(3);
  std::latch together(3);
  for (int i = 0; i < 3; ++i) background.submit([&] { together.arrive_and_wait(); });
  background.wait();
}

TEST(WorkerThreads, OneThreadKeepsTheOrderAndTheEndWaitsForAll) {
  std::vector<int> order;
  {
    WorkerThreads background(1);
    for (int i = 0; i < 100; ++i) background.submit([&, i] { order.push_back(i); });
  }
  ASSERT_EQ(order.size(), 100u);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], i);
}

TEST(WorkerThreads, WhatAJobSubmitsComesBeforeAllThatWaits) {
  std::string order;
  {
    WorkerThreads background(1);
    std::latch all_there(1);
    background.submit([&] { all_there.wait(); });
    for (const char name : {'a', 'b'})
      background.submit([&, name] {
        order += name;
        background.submit([&, name] { order += static_cast<char>(name - 'a' + 'A'); });
      });
    all_there.count_down();
  }
  EXPECT_EQ(order, "aAbB");
}

TEST(WorkerThreads, WhatIsDroppedNeverRunsAndWhatRunsEnds) {
  std::atomic<int> ended = 0, dropped = 0;
  std::latch begun(1), told(1);
  {
    WorkerThreads threads(1);
    threads.submit([&] {
      begun.count_down();
      told.wait();
      threads.submit([&] { ++dropped; });
      ++ended;
    });
    for (int i = 0; i < 100; ++i) threads.submit([&] { ++dropped; });
    begun.wait();
    threads.drop_waiting();
    told.count_down();
    threads.wait();
    EXPECT_EQ(ended, 1);
  }
  EXPECT_EQ(dropped, 0);
}

TEST(WorkerThreads, WhatIsSubmittedFirstComesBeforeAllThatWaits) {
  std::string order;
  {
    WorkerThreads background(1);
    std::latch all_there(1);
    background.submit([&] { all_there.wait(); });
    background.submit([&] { order += 'a'; });
    background.submit_first([&] { order += 'b'; });
    all_there.count_down();
  }
  EXPECT_EQ(order, "ba");
}

TEST(WorkerThreads, OfLoweredPriorityGiveWayToOthersAndLeaveThemAsTheyAre) {
  const int before = getpriority(PRIO_PROCESS, static_cast<id_t>(gettid()));
  WorkerThreads background(1, WorkerThreads::Priority::kLowered);
  int there = before;
  background.submit([&] { there = getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); });
  background.wait();
  EXPECT_TRUE(there > before || before > 14) << there;
  EXPECT_EQ(getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())), before);
}

}  // namespace
}  // namespace skerry
