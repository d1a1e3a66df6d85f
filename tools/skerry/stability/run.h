#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/skerry/stability/case.h"

namespace skerry::tools::stability {

/// A row and the case it comes from.
struct Outcome {
  std::string case_name;
  Row row;
};

/// The cases whose name, or group before the dot, is among `wanted`; without any, all. Errors: a
/// name that fits no case; names the nearest.
Result<std::vector<Case>> chosen_cases(std::span<const Case> all,
                                       std::span<const std::string> wanted);

/// Runs cases one after another. A case that cannot be run gives one row that does not pass and
/// says why. @param device null only when no case needs one.
/// @param progress called before each case with the number of cases done.
std::vector<Outcome> run_cases(std::span<const Case> cases, gpu::Device* device,
                               const std::function<void(std::size_t done)>& progress);

/// kDone when there are rows and all pass, else kFailed.
int status_of(std::span<const Outcome> outcomes);

/// A table in Markdown, which docs/stability_rows.md keeps; numbers with three digits.
std::string table_of(std::span<const Outcome> outcomes);
/// Rows of case, quantity, bound, observed, pass. What is not finite becomes null.
nlohmann::ordered_json rows_of(std::span<const Outcome> outcomes);

}  // namespace skerry::tools::stability
