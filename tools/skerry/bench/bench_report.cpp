#include "tools/skerry/bench/bench_report.h"

#include <algorithm>
#include <cmath>

#include "engine/core/check.h"
#include "engine/core/output.h"

namespace skerry::tools {

Spread spread_of(std::vector<double> samples) {
  SKERRY_ASSERT(!samples.empty());
  std::sort(samples.begin(), samples.end());
  const auto rank = [&](double q) {
    const double place = std::ceil(q * static_cast<double>(samples.size())) - 1.0;
    return samples[static_cast<std::size_t>(std::max(place, 0.0))];
  };
  Spread out{rank(0.10), rank(0.50), rank(0.90), rank(0.99), samples.back(), 0};
  out.over_twice = std::ranges::count_if(samples, [&](double ms) { return ms > 2.0 * out.median; });
  return out;
}

Result<void> write_rows(const std::optional<std::filesystem::path>& file,
                        const nlohmann::ordered_json& rows) {
  if (!file) return {};
  return write_text(*file, nlohmann::ordered_json{{"rows", rows}}.dump(
                               2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
                               "\n");
}

}  // namespace skerry::tools
