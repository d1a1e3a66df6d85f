#include "engine/core/jobs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace skerry {
namespace {

TEST(Jobs, EveryIndexIsVisitedOnce) {
  for (const int threads : {1, 2, 8}) {
    Jobs jobs(threads);
    EXPECT_EQ(jobs.threads(), threads);
    std::vector<std::atomic<int>> visits(1000);
    jobs.parallel_for(1000, [&](int i) { ++visits[static_cast<std::size_t>(i)]; });
    for (const std::atomic<int>& count : visits) EXPECT_EQ(count, 1);
  }
}

TEST(Jobs, WaitCoversJobsThatJobsSubmit) {
  for (const int threads : {1, 2, 8}) {
    Jobs jobs(threads);
    std::atomic<int> done = 0;
    const std::function<void(int)> split = [&](int depth) {
      if (depth > 0) {
        jobs.submit([&split, depth] { split(depth - 1); });
        jobs.submit([&split, depth] { split(depth - 1); });
      }
      ++done;
    };
    jobs.submit([&] { split(8); });
    jobs.wait();
    EXPECT_EQ(done, (1 << 9) - 1);
  }
}

TEST(Jobs, AsManyThreadsAsAskedForRunAtOnce) {
  for (const int threads : {1, 2, 5}) {
    Jobs jobs(threads);
    std::atomic<int> running = 0;
    for (int i = 0; i < threads; ++i) {
      jobs.submit([&] {
        ++running;
        // All must get here together; a pool with fewer threads never gets past.
        for (int spin = 0; running < threads && spin < 5000; ++spin)
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
      });
    }
    jobs.wait();
    EXPECT_EQ(running, threads);
  }
}

TEST(Jobs, NeverMoreThreadsThanAskedFor) {
  Jobs jobs(2);
  std::atomic<int> running = 0, most = 0;
  for (int i = 0; i < 200; ++i) {
    jobs.submit([&] {
      const int now = ++running;
      int seen = most;
      while (now > seen && !most.compare_exchange_weak(seen, now)) {
      }
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      --running;
    });
  }
  jobs.wait();
  EXPECT_LE(most, 2);
}

TEST(Jobs, TheDestructorFinishesWhatWasSubmitted) {
  std::atomic<int> done = 0;
  {
    Jobs jobs(2);
    for (int i = 0; i < 100; ++i) jobs.submit([&] { ++done; });
  }
  EXPECT_EQ(done, 100);
}

TEST(Jobs, OneBesideAnotherHasNoMoreThreadsAndTbbSaysNothing) {
  const Jobs outer(2);
  testing::internal::CaptureStderr();
  std::atomic<int> done = 0;
  {
    Jobs inner(64);
    EXPECT_EQ(inner.threads(), 2);
    inner.parallel_for(100, [&](int) { ++done; });
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(done, 100);
}

TEST(Jobs, ParallelForOfNothingReturns) {
  Jobs jobs(1);
  jobs.parallel_for(0, [](int) { FAIL(); });
  jobs.parallel_for(-1, [](int) { FAIL(); });
}

}  // namespace
}  // namespace skerry
