#pragma once
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "engine/core/result.h"

namespace skerry::tools {

/// Order statistics of repeated timings.
struct Spread {
  double p10 = 0.0, median = 0.0, p90 = 0.0, p99 = 0.0, max = 0.0;
  std::int64_t over_twice = 0;  ///< samples that took more than twice the median
};

/// @param samples not empty; nearest-rank quantiles.
Spread spread_of(std::vector<double> samples);

/// Writes `{"rows": rows}` when a file is wanted.
Result<void> write_rows(const std::optional<std::filesystem::path>& file,
                        const nlohmann::ordered_json& rows);

}  // namespace skerry::tools
