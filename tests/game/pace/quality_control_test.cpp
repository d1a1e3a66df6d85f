#include "game/pace/quality_control.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/skerry/stability/simulated_machine.h"

namespace skerry::game {
namespace {

using tools::stability::Noise;
using tools::stability::simulate;
using tools::stability::SimulatedRun;

constexpr double kBudget = 33.0;
const std::vector<double> kPriors{10.0, 20.0, 30.0, 40.0, 60.0};

QualityControl fresh(std::size_t point = 2) {
  const std::size_t probes[] = {point, 0};
  return begin_control(point, kPriors, {}, probes);
}
QualityControl learnt(std::size_t point) {
  return begin_control(point, kPriors, {10.0, 20.0, 30.0, 40.0, 60.0}, {});
}
/// Times are the table's, so many times over.
auto times(double factor) {
  return [factor](std::size_t point, double) { return kPriors[point] * factor; };
}

TEST(QualityControl, MeasuresItsProbesThenTakesTheBestThatFits) {
  // At half the table's times point 4 takes 30 ms, over the 28 ms aimed at; 3 takes 20.
  const SimulatedRun run = simulate(fresh(), times(0.5), 3.0, kBudget);
  EXPECT_EQ(run.points, (std::vector<std::size_t>{2, 0, 3}));
  EXPECT_EQ(run.control.costs_ms[2], 15.0);
  EXPECT_EQ(run.control.costs_ms[0], 5.0);
  EXPECT_EQ(run.control.reason, Reason::kFits);
}

TEST(QualityControl, WithLearntCostsNothingIsProbed) {
  const SimulatedRun run = simulate(learnt(1), times(1.0), 60.0, kBudget);
  EXPECT_TRUE(run.changes_s.empty());
}

TEST(QualityControl, StepsDownWithinASecondAndToWhatFits) {
  for (const double factor : {1.5, 2.5, 6.0}) {
    const SimulatedRun run = simulate(learnt(2), times(factor), 10.0, kBudget);
    ASSERT_EQ(run.changes_s.size(), 1u) << factor;
    EXPECT_LT(run.changes_s[0], 1.0) << factor;
    const std::size_t point = run.control.point;
    if (point > 0) {
      EXPECT_LE(kPriors[point] * factor, kAimShare * kBudget) << factor;
    }
    EXPECT_GT(kPriors[point + 1] * factor, kAimShare * kBudget) << factor;
    EXPECT_EQ(run.control.reason, Reason::kLate);
  }
}

TEST(QualityControl, StepsUpNoSoonerThanItsWait) {
  const SimulatedRun run = simulate(learnt(0), times(0.5), 60.0, kBudget);
  ASSERT_FALSE(run.changes_s.empty());
  EXPECT_GE(run.changes_s[0], kFirstRaiseWait);
  EXPECT_EQ(run.control.point, 3u);
  EXPECT_EQ(run.turns, 0);
}

TEST(QualityControl, ARaiseThatDoesNotHoldIsNotTriedAgain) {
  // Point 2 takes twice what was learnt: it is tried once, and then known.
  const auto cost = [](std::size_t point, double) {
    return point == 2 ? 60.0 : kPriors[point] / 2;
  };
  QualityControl control = begin_control(1, {10.0, 20.0, 30.0}, {10.0, 20.0, 30.0}, {});
  const SimulatedRun run = simulate(control, cost, 3600.0, kBudget);
  EXPECT_EQ(run.points, (std::vector<std::size_t>{1, 2, 1}));
}

TEST(QualityControl, OneHitchChangesNothing) {
  QualityControl control = learnt(1);
  for (int i = 0; i < 300; ++i) {
    const double ms = i % 60 == 59 ? 400.0 : 20.0;
    control = next_control(std::move(control), {.now_s = i * 0.033, .work_ms = ms}, kBudget);
    ASSERT_EQ(control.point, 1u) << i;
  }
}

TEST(QualityControl, HeldItKeepsItsPointWhateverFramesTake) {
  QualityControl control = fresh();
  for (int i = 0; i < 1000; ++i) {
    const double ms = i % 2 ? 1.0 : 900.0;
    control =
        next_control(std::move(control), {.now_s = i * 0.1, .work_ms = ms, .held = true}, kBudget);
    ASSERT_EQ(control.point, 2u);
  }
  // Frames from before it was held play no part afterwards.
  EXPECT_TRUE(control.samples.empty());
}

TEST(QualityControl, ProbesWaitUntilTheWorldIsThere) {
  QualityControl control = fresh();
  for (int i = 0; i < 100; ++i)
    control = next_control(std::move(control),
                           {.now_s = i * 0.02, .work_ms = 15.0, .settled = false}, kBudget);
  EXPECT_EQ(control.probes.size(), 2u);
}

TEST(QualityControl, FrameTimesThatAreNoneAreIgnored) {
  const QualityControl before = learnt(2);
  for (const double ms : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    const QualityControl after = next_control(before, {.now_s = 1.0, .work_ms = ms}, kBudget);
    EXPECT_EQ(after.samples.size(), before.samples.size());
    EXPECT_EQ(after.point, before.point);
  }
}

// Properties, on machines made by chance.

TEST(QualityControl, OnAnyMachineItStaysInRangeAndKeepsFewSamples) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Noise noise(seed);
    QualityControl control = fresh(seed % kPriors.size());
    double now_s = 0.0;
    for (int i = 0; i < 2000; ++i) {
      const double ms = std::pow(10.0, 5.0 * noise() - 1.0);  // 0.1 ms to 10 s
      now_s += ms * 1e-3;
      control = next_control(
          std::move(control),
          {.now_s = now_s, .work_ms = ms, .settled = noise() < 0.5, .held = noise() < 0.1},
          kBudget);
      ASSERT_LT(control.point, kPriors.size());
      ASSERT_TRUE(std::isfinite(control.mean_ms));
      if (control.samples.size() > 3) {
        ASSERT_LT(control.samples.back().now_s - control.samples.front().now_s, kLongWindow);
      }
      for (const auto& cost : control.costs_ms)
        ASSERT_TRUE(!cost || (*cost > 0.0 && std::isfinite(*cost)));
    }
  }
}

TEST(QualityControl, TheSameFramesGiveTheSameChoices) {
  const auto run = [] {
    Noise noise(7);
    return simulate(
        fresh(), [&](std::size_t point, double) { return kPriors[point] * (0.5 + noise()); }, 300.0,
        kBudget);
  };
  const SimulatedRun first = run(), second = run();
  EXPECT_EQ(first.points, second.points);
  EXPECT_EQ(first.changes_s, second.changes_s);
}

TEST(QualityControl, AFasterMachineNeverEndsWithLess) {
  std::size_t least = 0;
  for (double factor = 4.0; factor > 0.1; factor *= 0.9) {
    const SimulatedRun run = simulate(fresh(), times(factor), 600.0, kBudget);
    EXPECT_GE(run.control.point, least) << factor;
    least = run.control.point;
    if (run.control.point > 0) {
      EXPECT_LE(kPriors[run.control.point] * factor, kLateShare * kBudget) << factor;
    }
  }
  EXPECT_EQ(least, kPriors.size() - 1);
}

}  // namespace
}  // namespace skerry::game
