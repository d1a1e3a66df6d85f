#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/core/check.h"

namespace skerry::measure {

/// The nearest-rank quantile: the smallest value that at least `share` (0..1) of all do not exceed.
/// Reorders `values`. @pre not empty, no NaN.
template <class T>
T quantile(std::vector<T>& values, double share) {
  SKERRY_ASSERT(!values.empty() && share >= 0.0 && share <= 1.0);
  // The small term keeps 0.999 of 1000 at rank 999 although the product rounds to above it.
  const double rank = std::ceil(share * static_cast<double>(values.size()) - 1e-9);
  const auto index = static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

}  // namespace skerry::measure
