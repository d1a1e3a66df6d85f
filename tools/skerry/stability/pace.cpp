// The choice of quality on machines that are noisy, are given more to do, or throttle.
#include <algorithm>
#include <cmath>
#include <vector>

#include "game/pace/quality_control.h"
#include "game/pace/quality_front.h"
#include "tools/skerry/stability/case.h"
#include "tools/skerry/stability/simulated_machine.h"

namespace skerry::tools::stability {
namespace {

using game::QualityControl;

constexpr double kBudgetMs = 1000.0 / 30.0, kProbing = 10.0;
constexpr int kMachines = 24;  // from one that holds nothing to one that holds everything

std::vector<double> priors() {
  std::vector<double> ms;
  for (const game::FrontPoint& point : game::quality_front()) ms.push_back(point.prior_ms);
  return ms;
}

QualityControl fresh() {
  const std::size_t probes[] = {2, 1, 3};
  return game::begin_control(2, priors(), {}, probes);
}

/// Times of one machine: each 2^(1/4) as fast as the one before, and not quite as the table's was.
FrameCost machine(int number) {
  return [ms = priors(), speed = 0.25 * std::exp2(0.25 * number)](std::size_t point, double) {
    return std::pow(ms[point], 1.1) / speed;
  };
}

Result<Rows> noise() {
  double changes = 0.0, moved = 0.0;
  for (int m = 0; m < kMachines; ++m) {
    Noise noise(static_cast<std::uint64_t>(m));
    const FrameCost cost = machine(m);
    const auto noisy = [&](std::size_t point, double now_s) {
      return cost(point, now_s) * (0.7 + 0.6 * noise());
    };
    // The first minutes may end with a raise or two that do not hold.
    const SimulatedRun run = simulate(fresh(), noisy, 1500.0, kBudgetMs, 300.0);
    changes += static_cast<double>(run.changes_s.size());
    moved += run.control.point != 2;
  }
  return Rows{{"changes in 20 minutes, 24 machines, times 30% up and down", 0.0,
               if_shown(moved > 0.0, changes)}};
}

/// From its 60th second on a machine has `load` times as much to do.
Result<Rows> load_step() {
  constexpr double kStep = 60.0;
  double longest_s = 0.0, turns = 0.0, stepped = 0.0;
  for (int m = 0; m < kMachines; ++m) {
    for (const double load : {1.5, 2.0, 4.0}) {
      const FrameCost cost = machine(m);
      const auto loaded = [&](std::size_t point, double now_s) {
        return cost(point, now_s) * (now_s < kStep ? 1.0 : load);
      };
      const SimulatedRun run = simulate(fresh(), loaded, 300.0, kBudgetMs, kStep);
      // Where even the cheapest is late, nothing can be done.
      if (cost(0, 0.0) * load > game::kLateShare * kBudgetMs || run.changes_s.empty()) continue;
      ++stepped;
      longest_s = std::max(longest_s, run.changes_s.front() - kStep);
      turns += run.turns;
    }
  }
  return Rows{{"seconds until frames that are late are drawn with less, loads of 1.5 to 4", 1.0,
               if_shown(stepped > 0.0, longest_s)},
              {"turns after a step of load, 24 machines", 0.0, if_shown(stepped > 0.0, turns)}};
}

/// Two minutes at full speed, two at three fifths of it, by turns.
Result<Rows> throttling() {
  constexpr double kPhase = 120.0, kPhases = 10.0, kThrottled = 5.0 / 3.0;
  double turns = 0.0, late_s = 0.0;
  for (int m = 0; m < kMachines; ++m) {
    const FrameCost cost = machine(m);
    if (cost(0, 0.0) * kThrottled > game::kLateShare * kBudgetMs) continue;
    const auto throttled = [&](std::size_t point, double now_s) {
      return cost(point, now_s) * (std::fmod(now_s, 2.0 * kPhase) < kPhase ? 1.0 : kThrottled);
    };
    const SimulatedRun run = simulate(fresh(), throttled, kPhases * kPhase, kBudgetMs, kProbing);
    turns = std::max(turns, static_cast<double>(run.turns));
    late_s = std::max(late_s, run.longest_late_s);
  }
  // One change at the beginning of each phase, the other way than the one before.
  return Rows{{"turns in 20 minutes, a machine that throttles every four", kPhases,
               if_shown(turns > 0.0, turns)},
              {"longest late stretch of it [s]", 1.0, if_shown(turns > 0.0, late_s)}};
}

constexpr Case kPaceCases[] = {
    {"pace.noise", noise}, {"pace.load_step", load_step}, {"pace.throttling", throttling}};

}  // namespace

std::span<const Case> pace_cases() {
  return kPaceCases;
}

}  // namespace skerry::tools::stability
