// Machines that a QualityControl is let loose on.
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "game/pace/quality_control.h"

namespace skerry::tools::stability {

/// What the control did on a machine.
struct SimulatedRun {
  game::QualityControl control;     ///< at the end
  std::vector<double> changes_s;    ///< when the point changed
  std::vector<std::size_t> points;  ///< before the first and after each change
  int turns = 0;                    ///< changes the other way than the change before
  double longest_late_s = 0.0;      ///< of late frames in a row
};

/// What a frame takes [ms] at a point and a time.
using FrameCost = std::function<double(std::size_t point, double now_s)>;

/// Lets frames follow one another, none sooner than the budget after the one before.
inline SimulatedRun simulate(game::QualityControl control, const FrameCost& cost, double seconds,
                             double budget_ms, double counted_from_s = 0.0) {
  SimulatedRun run;
  run.points.push_back(control.point);
  int direction = 0;
  double late_s = 0.0;
  for (double now_s = 0.0; now_s < seconds;) {
    const double ms = cost(control.point, now_s);
    now_s += std::max(ms, budget_ms) * 1e-3;
    const std::size_t before = control.point;
    control = game::next_control(std::move(control), {.now_s = now_s, .work_ms = ms}, budget_ms);
    if (now_s < counted_from_s) {
      run.points.back() = control.point;
      continue;
    }
    late_s = ms > game::kLateShare * budget_ms ? late_s + ms * 1e-3 : 0.0;
    run.longest_late_s = std::max(run.longest_late_s, late_s);
    if (control.point == before) continue;
    run.changes_s.push_back(now_s);
    run.points.push_back(control.point);
    const int now = control.point > before ? 1 : -1;
    run.turns += direction != 0 && now != direction;
    direction = now;
  }
  run.control = std::move(control);
  return run;
}

/// Numbers from 0 to 1 that look random and are the same everywhere.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 1) {}
  double operator()() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

}  // namespace skerry::tools::stability
