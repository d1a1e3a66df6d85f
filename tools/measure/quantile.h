#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/core/check.h"

namespace skerry::measure {

/// Index, of that many sorted values, of the nearest-rank quantile.
inline std::size_t rank_of(std::size_t count, double share) {
  // The small term keeps 0.999 of 1000 at rank 999 although the product rounds to above it.
  const double rank = std::ceil(share * static_cast<double>(count) - 1e-9);
  return static_cast<std::size_t>(std::max(rank, 1.0)) - 1;
}

/// The nearest-rank quantile: the smallest value that at least `share` (0..1) of all do not exceed.
/// Reorders `values`. @pre not empty, no NaN.
template <class T>
T quantile(std::vector<T>& values, double share) {
  SKERRY_ASSERT(!values.empty() && share >= 0.0 && share <= 1.0);
  const std::size_t index = rank_of(values.size(), share);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(index),
                   values.end());
  return values[index];
}

}  // namespace skerry::measure
