#include "tools/measure/pareto.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace skerry::measure {
namespace {

TEST(Pareto, FrontIsWhatNothingDominates) {
  std::mt19937 random(1);
  for (int round = 0; round < 300; ++round) {
    // Few distinct values, so that ties of all kinds occur.
    std::vector<Cost> costs(random() % 12);
    for (Cost& cost : costs)
      cost = {static_cast<double>(random() % 5), static_cast<double>(random() % 5)};
    std::vector<std::size_t> expected;
    for (std::size_t i = 0; i < costs.size(); ++i)
      if (std::none_of(costs.begin(), costs.end(),
                       [&](const Cost& other) { return dominates(other, costs[i]); }))
        expected.push_back(i);
    std::stable_sort(expected.begin(), expected.end(),
                     [&](std::size_t a, std::size_t b) { return costs[a].time < costs[b].time; });
    EXPECT_EQ(pareto_front(costs), expected);
  }
}

TEST(Pareto, DominationNeedsOneBetterAndNoneWorse) {
  EXPECT_TRUE(dominates({1, 2}, {2, 2}));
  EXPECT_TRUE(dominates({2, 1}, {2, 2}));
  EXPECT_FALSE(dominates({2, 2}, {2, 2}));
  EXPECT_FALSE(dominates({1, 3}, {2, 2}));
}

}  // namespace
}  // namespace skerry::measure
