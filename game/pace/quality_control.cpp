#include "game/pace/quality_control.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/check.h"

namespace skerry::game {
namespace {

constexpr int kSkippedFrames = 3;  // on their way when the point changes
constexpr std::size_t kFewestSamples = 3;
constexpr std::size_t kProbeSamples = 8;
constexpr double kHopeless = 3.0;      // times the budget: two frames are enough
constexpr double kSteadyShare = 0.12;  // by which the halves of a window may differ
constexpr double kHitch = 1.5;         // times the median: what lies above counts as that
constexpr double kRaiseTrial = 60.0;   // seconds within which a step down takes a raise back
constexpr double kRaiseProved =
    120.0;  // seconds that a raise holds after which raises are quick again

using Samples = std::span<const QualityControl::Sample>;

/// The samples of the last `seconds`, and no fewer than a mean needs while there are so many.
Samples last(Samples all, double seconds) {
  std::size_t first = all.size();
  while (first > 0 &&
         (all.size() - first < kFewestSamples || all.back().now_s - all[first - 1].now_s < seconds))
    --first;
  return all.subspan(first);
}

/// Mean of the samples in which one hitch counts little.
double mean_ms(Samples samples) {
  std::vector<double> sorted;
  for (const auto& sample : samples) sorted.push_back(sample.ms);
  std::sort(sorted.begin(), sorted.end());
  const double most = kHitch * sorted[sorted.size() / 2];
  double sum = 0.0;
  for (const double ms : sorted) sum += std::min(ms, most);
  return sum / static_cast<double>(sorted.size());
}

bool spans(Samples samples, double seconds) {
  return samples.size() >= kFewestSamples &&
         samples.back().now_s - samples.front().now_s + samples.front().ms * 1e-3 >= seconds;
}

/// Whether the load has not changed within the samples.
bool is_steady(Samples samples) {
  const std::size_t half = samples.size() / 2;
  const double before = mean_ms(samples.first(half)), after = mean_ms(samples.subspan(half));
  return std::abs(before - after) <= kSteadyShare * std::max(before, after);
}

void move_to(QualityControl& control, std::size_t point, Reason reason, double now_s) {
  control.point = point;
  control.reason = reason;
  control.samples.clear();
  control.to_skip = kSkippedFrames;
  control.changed_s = now_s;
}

/// The most exact point that fits the budget, if the present one takes `now_ms`; none: not even the
/// cheapest.
std::optional<std::size_t> fitting(const QualityControl& control, double now_ms, double budget_ms) {
  const std::optional<double> here = expected_ms(control, control.point);
  const double load = here ? now_ms / *here : 1.0;
  for (std::size_t i = control.priors_ms.size(); i-- > 0;) {
    const double ms = here ? *expected_ms(control, i) * load
                           : now_ms * control.priors_ms[i] / control.priors_ms[control.point];
    const bool known = i == control.point || control.costs_ms[i].has_value();
    if (ms <= (known ? kAimShare : kGuessShare) * budget_ms) return i;
  }
  return std::nullopt;
}

/// Measures one point after another, then chooses.
void probe(QualityControl& control, double now_s, double budget_ms) {
  if (control.point != control.probes.back())
    return move_to(control, control.probes.back(), Reason::kProbing, now_s);
  control.reason = Reason::kProbing;
  if (control.samples.size() < kProbeSamples) return;
  const double ms = mean_ms(control.samples);
  control.costs_ms[control.point] = ms;
  control.probes.pop_back();
  if (!control.probes.empty())
    return move_to(control, control.probes.back(), Reason::kProbing, now_s);
  move_to(control, fitting(control, ms, budget_ms).value_or(0), Reason::kFits, now_s);
}

/// How the present point compares with the one that it was raised from, at the same load. Where
/// that contradicts what was known of both, each takes half of the difference.
void learn_raise(QualityControl& control, double ms) {
  if (control.before_raise_ms <= 0.0) return;
  const double ratio = ms / control.before_raise_ms;
  control.before_raise_ms = 0.0;
  std::optional<double>& from = control.costs_ms[control.before_raise];
  std::optional<double>& to = control.costs_ms[control.point];
  if (!from && !to) from = expected_ms(control, control.before_raise).value_or(ms / ratio);
  if (!to) {
    to = *from * ratio;
  } else if (!from) {
    from = *to / ratio;
  } else {
    const double half = std::sqrt(*from * ratio / *to);
    *to *= half;
    *from /= half;
  }
}

bool step_down(QualityControl& control, double now_s, double budget_ms) {
  const Samples recent = last(control.samples, kShortWindow);
  if (recent.size() < 2) return false;
  const double ms = mean_ms(recent);
  const bool hopeless =
      std::min(recent.back().ms, recent[recent.size() - 2].ms) > kHopeless * budget_ms;
  if (!hopeless && !spans(recent, 0.6 * kShortWindow)) return false;
  if (ms <= kLateShare * budget_ms) return false;
  learn_raise(control, ms);
  if (control.point == 0) return false;
  if (control.raised_s && now_s - *control.raised_s < kRaiseTrial)
    control.raise_wait_s = std::min(2.0 * control.raise_wait_s, kLongestRaiseWait);
  const std::size_t to = std::min(fitting(control, ms, budget_ms).value_or(0), control.point - 1);
  move_to(control, to, Reason::kLate, now_s);
  return true;
}

void step_up(QualityControl& control, double now_s, double budget_ms) {
  if (!spans(control.samples, 0.9 * kLongWindow) || !is_steady(control.samples)) return;
  const double ms = mean_ms(control.samples);
  learn_raise(control, ms);
  if (control.raised_s == control.changed_s && now_s - control.changed_s > kRaiseProved)
    control.raise_wait_s = kFirstRaiseWait;
  if (now_s - control.changed_s < control.raise_wait_s) return;
  const std::size_t to = fitting(control, ms, budget_ms).value_or(0);
  if (to <= control.point) return;
  control.before_raise = control.point;
  control.before_raise_ms = ms;
  control.raised_s = now_s;
  move_to(control, to, Reason::kSpare, now_s);
}

}  // namespace

QualityControl begin_control(std::size_t point, std::vector<double> priors_ms,
                             std::vector<std::optional<double>> costs_ms,
                             std::span<const std::size_t> probes) {
  SKERRY_ASSERT(point < priors_ms.size());
  QualityControl control;
  control.point = point;
  control.raise_wait_s = kFirstRaiseWait;
  if (costs_ms.empty()) {
    costs_ms.resize(priors_ms.size());
    control.probes.assign(probes.rbegin(), probes.rend());
  } else {
    control.reason = Reason::kFits;
  }
  SKERRY_ASSERT(costs_ms.size() == priors_ms.size());
  control.priors_ms = std::move(priors_ms);
  control.costs_ms = std::move(costs_ms);
  return control;
}

std::optional<double> expected_ms(const QualityControl& control, std::size_t point) {
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < control.costs_ms.size(); ++i) {
    const auto apart = [point](std::size_t j) { return j < point ? point - j : j - point; };
    if (control.costs_ms[i] && (!nearest || apart(i) < apart(*nearest))) nearest = i;
  }
  if (!nearest) return std::nullopt;
  return *control.costs_ms[*nearest] * control.priors_ms[point] / control.priors_ms[*nearest];
}

QualityControl next_control(QualityControl control, const FrameFacts& frame, double budget_ms) {
  if (!(frame.work_ms > 0.0) || !std::isfinite(frame.work_ms)) return control;
  if (frame.held) {
    control.samples.clear();
    control.to_skip = kSkippedFrames;
    return control;
  }
  if (control.to_skip > 0) {
    --control.to_skip;
    return control;
  }
  control.samples.push_back({frame.now_s, frame.work_ms});
  const std::size_t kept = last(control.samples, kLongWindow).size();
  control.samples.erase(control.samples.begin(),
                        control.samples.end() - static_cast<std::ptrdiff_t>(kept));
  control.mean_ms = mean_ms(last(control.samples, kShortWindow));
  if (!control.probes.empty() && frame.settled) {
    probe(control, frame.now_s, budget_ms);
    return control;
  }
  if (!step_down(control, frame.now_s, budget_ms)) step_up(control, frame.now_s, budget_ms);
  return control;
}

}  // namespace skerry::game
