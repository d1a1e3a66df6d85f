#include "engine/core/shared_work.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <latch>
#include <memory>
#include <optional>
#include <set>
#include <thread>
#include <vector>

namespace skerry {
namespace {

TEST(SharedWork, DoesEachPieceOnce) {
  for (const int helpers : {1, 3}) {
    Helpers others(helpers);
    for (int pieces = 0; pieces < 40; ++pieces) {
      std::vector<int> done(static_cast<std::size_t>(pieces), 0);  // no two threads write to one
      SharedWork work(&others, pieces, [&](int i) { ++done[static_cast<std::size_t>(i)]; });
      work.join();
      work.join();
      EXPECT_EQ(std::count(done.begin(), done.end(), 1), pieces);
    }
  }
}

TEST(SharedWork, IsDoneByOneThreadWithoutHelpers) {
  std::vector<int> order;
  SharedWork work(nullptr, 5, [&](int i) { order.push_back(i); });
  EXPECT_TRUE(order.empty());
  work.join();
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(SharedWork, IsBegunByHelpers) {
  Helpers others(2);
  std::latch begun(2);
  std::vector<std::thread::id> by(2);
  SharedWork work(&others, 2, [&](int i) {
    by[static_cast<std::size_t>(i)] = std::this_thread::get_id();
    begun.arrive_and_wait();  // one thread alone would wait forever
  });
  begun.wait();
  work.join();
  EXPECT_EQ(std::set(by.begin(), by.end()).size(), 2u);
  EXPECT_EQ(std::count(by.begin(), by.end(), std::this_thread::get_id()), 0);
}

TEST(SharedWork, WaitsForNoHelperThatIsBusy) {
  Helpers others(1);
  std::latch busy(1), release(1);
  std::optional<SharedWork> long_one(std::in_place, &others, 1, [&](int) {
    busy.count_down();
    release.wait();
  });
  busy.wait();
  std::vector<std::thread::id> by(5);
  SharedWork(&others, 5, [&](int i) {
    by[static_cast<std::size_t>(i)] = std::this_thread::get_id();
  }).join();
  EXPECT_EQ(std::count(by.begin(), by.end(), std::this_thread::get_id()), 5);
  release.count_down();
  long_one.reset();
}

TEST(SharedWork, WaitsForPiecesThatHelpersAreInTheMiddleOf) {
  Helpers others(3);
  for (int round = 0; round < 200; ++round) {
    int sum = 0;
    {
      std::vector<int> parts(4, 0);
      SharedWork work(&others, 4, [&](int i) {
        if (i % 2 == 0) std::this_thread::yield();
        parts[static_cast<std::size_t>(i)] = i + 1;
      });
      work.join();
      for (const int part : parts) sum += part;
    }
    ASSERT_EQ(sum, 10) << "round " << round;
  }
}

// A helper that comes too late must not call what is gone.
TEST(SharedWork, LeavesNothingBehindForLateHelpers) {
  Helpers others(1);
  for (int round = 0; round < 2000; ++round) {
    auto count = std::make_unique<std::atomic<int>>(0);
    SharedWork(&others, 3, [&count = *count](int) { ++count; }).join();
    ASSERT_EQ(*count, 3);
  }
}

// Around the edges of a piece, none left out and none twice.
TEST(ShareCalls, CallsEachOnce) {
  for (const std::size_t count : {0, 1, 6, 7, 8, 14, 15, 100}) {
    std::vector<std::atomic<int>> calls(count);
    share_calls(count, 7, [&](std::size_t i) { ++calls[i]; });
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(calls[i], 1) << i << " of " << count;
  }
}

}  // namespace
}  // namespace skerry
