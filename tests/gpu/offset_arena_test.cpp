#include "engine/gpu/transfer/offset_arena.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace skerry::gpu {
namespace {

// The arena against a map of every element: who owns it, and until which timeline value the GPU may
// read it.
class ArenaModel {
 public:
  explicit ArenaModel(std::uint32_t capacity) : busy_until_(capacity, kFree) {}

  bool all_free(ArenaRange range) const {
    return std::all_of(busy_until_.begin() + range.first,
                       busy_until_.begin() + range.first + range.count,
                       [](std::uint64_t value) { return value == kFree; });
  }
  void mark(ArenaRange range, std::uint64_t value) {
    std::fill_n(busy_until_.begin() + range.first, range.count, value);
  }
  void collect(std::uint64_t completed) {
    for (std::uint64_t& value : busy_until_) {
      if (value != kAllocated && value <= completed) value = kFree;
    }
  }
  std::uint32_t largest_free() const {
    std::uint32_t largest = 0, run = 0;
    for (const std::uint64_t value : busy_until_) {
      run = value == kFree ? run + 1 : 0;
      largest = std::max(largest, run);
    }
    return largest;
  }
  static constexpr std::uint64_t kFree = 0, kAllocated = ~0ull;

 private:
  std::vector<std::uint64_t> busy_until_;
};

TEST(OffsetArena, RandomUseAgreesWithAMapOfEveryElement) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    constexpr std::uint32_t kCapacity = 2000;
    OffsetArena arena(kCapacity);
    ArenaModel model(kCapacity);
    std::vector<ArenaRange> live;
    std::uint64_t now = 1;
    for (int step = 0; step < 3000; ++step) {
      const auto action = random() % 10;
      if (action < 5) {
        const auto wanted = static_cast<std::uint32_t>(random() % 120 + 1);
        const Result<ArenaRange> got = arena.allocate(wanted);
        ASSERT_EQ(static_cast<bool>(got), model.largest_free() >= wanted);
        if (!got) continue;
        ASSERT_EQ(got->count, wanted);
        ASSERT_LE(got->first + got->count, kCapacity);
        ASSERT_TRUE(model.all_free(*got)) << "handed out twice, or while in flight";
        model.mark(*got, ArenaModel::kAllocated);
        live.push_back(*got);
      } else if (action < 9 && !live.empty()) {
        const std::size_t which = random() % live.size();
        arena.free(live[which], now);
        model.mark(live[which], now);
        live[which] = live.back();
        live.pop_back();
      } else {
        now += random() % 3;
        const std::uint64_t completed = now > 2 ? now - 2 : 0;
        arena.collect(completed);
        model.collect(completed);
      }
      ASSERT_EQ(arena.largest_free(), model.largest_free());
    }
  }
}

TEST(OffsetArena, TheBestFitIsTakenSoThatLargeRunsLast) {
  OffsetArena arena(100);
  const ArenaRange a = *arena.allocate(10), b = *arena.allocate(50), c = *arena.allocate(5);
  static_cast<void>(b);
  arena.free(a, 1);
  arena.collect(1);
  EXPECT_EQ(arena.allocate(8)->first, a.first);
  EXPECT_EQ(arena.largest_free(), 35u);
  EXPECT_EQ(c.first, 60u);
}

TEST(OffsetArena, FreedRangesWaitForTheGpu) {
  OffsetArena arena(10);
  const ArenaRange all = *arena.allocate(10);
  arena.free(all, 7);
  EXPECT_EQ(arena.waiting(), 10u);
  EXPECT_EQ(arena.used(), 0u);
  arena.collect(6);
  EXPECT_FALSE(arena.allocate(1));
  arena.collect(7);
  EXPECT_EQ(arena.waiting(), 0u);
  EXPECT_TRUE(arena.allocate(10));
}

TEST(OffsetArena, AFullArenaSaysWhatIsLeftAndWhatToDo) {
  OffsetArena arena(10);
  ASSERT_TRUE(arena.allocate(7));
  const Result<ArenaRange> got = arena.allocate(4);
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error().message,
            "the quad arena has no run of 4: 3 of 10 are free, the largest run is 3; lower "
            "view.distance");
}

TEST(OffsetArena, NothingIsAlwaysThere) {
  OffsetArena arena(0);
  const Result<ArenaRange> nothing = arena.allocate(0);
  ASSERT_TRUE(nothing);
  arena.free(*nothing, 1);
  EXPECT_FALSE(arena.allocate(1));
  EXPECT_EQ(arena.largest_free(), 0u);
}

TEST(OffsetArena, GrowingJoinsTheNewRoomToTheFreeEnd) {
  OffsetArena arena(10);
  ASSERT_TRUE(arena.allocate(4));
  arena.grow(30);
  EXPECT_EQ(arena.capacity(), 30u);
  EXPECT_EQ(arena.largest_free(), 26u);
  EXPECT_EQ(arena.allocate(26)->first, 4u);
}

TEST(OffsetArenaDeathTest, FreeingTwiceIsCaught) {
  OffsetArena arena(10);
  const ArenaRange a = *arena.allocate(5);
  ASSERT_TRUE(arena.allocate(5));
  arena.free(a, 1);
  arena.free(a, 1);
  EXPECT_DEATH(arena.collect(1), "assertion failed");
}

}  // namespace
}  // namespace skerry::gpu
