#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace skerry::measure {

/// What a choice costs and what it gets wrong; less of both is better. Not NaN.
struct Cost {
  double time = 0.0;
  double error = 0.0;
};

/// Whether `a` is no worse than `b` in both and better in one.
bool dominates(const Cost& a, const Cost& b);

/// Indices of the costs that no other dominates, by rising time, then by index. Equal costs that
/// are on the front are all on it.
std::vector<std::size_t> pareto_front(std::span<const Cost> costs);

}  // namespace skerry::measure
