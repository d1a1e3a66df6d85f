#include "tools/measure/pareto.h"

#include <algorithm>
#include <numeric>

namespace skerry::measure {

bool dominates(const Cost& a, const Cost& b) {
  return a.time <= b.time && a.error <= b.error && (a.time < b.time || a.error < b.error);
}

std::vector<std::size_t> pareto_front(std::span<const Cost> costs) {
  std::vector<std::size_t> order(costs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (costs[a].time != costs[b].time) return costs[a].time < costs[b].time;
    if (costs[a].error != costs[b].error) return costs[a].error < costs[b].error;
    return a < b;
  });
  // By rising time, a cost is on the front when its error is below all before it, or when it equals
  // the last one that was.
  std::vector<std::size_t> front;
  for (const std::size_t i : order) {
    const bool first = front.empty();
    const Cost& last = first ? costs[i] : costs[front.back()];
    const bool equal = costs[i].time == last.time && costs[i].error == last.error;
    if (first || equal || costs[i].error < last.error) front.push_back(i);
  }
  return front;
}

}  // namespace skerry::measure
