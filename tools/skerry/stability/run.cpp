#include "tools/skerry/stability/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "engine/core/check.h"
#include "game/scene_file/parse.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools::stability {
namespace {

std::string_view group_of(std::string_view name) {
  return name.substr(0, name.find('.'));
}

bool fits(const Case& one, std::string_view wanted) {
  return one.name == wanted || group_of(one.name) == wanted;
}

Result<Rows> rows_from(const Case& one, gpu::Device* device) {
  if (const auto* on_cpu = std::get_if<Case::OnCpu>(&one.run)) return (*on_cpu)();
  SKERRY_ASSERT(device != nullptr);
  return std::get<Case::OnDevice>(one.run)(*device);
}

}  // namespace

Result<std::vector<Case>> chosen_cases(std::span<const Case> all,
                                       std::span<const std::string> wanted) {
  for (const std::string& name : wanted) {
    if (std::any_of(all.begin(), all.end(), [&](const Case& one) { return fits(one, name); }))
      continue;
    std::vector<std::string_view> names;
    for (const Case& one : all) {
      names.push_back(one.name);
      names.push_back(group_of(one.name));
    }
    return Error{
        fmt::format("there is no stability case {}: did you mean '{}'? 'skerry stability "
                    "--list' names all",
                    game::quote_text(name), game::nearest_name(name, names))};
  }
  std::vector<Case> chosen;
  std::copy_if(all.begin(), all.end(), std::back_inserter(chosen), [&](const Case& one) {
    return wanted.empty() || std::any_of(wanted.begin(), wanted.end(),
                                         [&](const std::string& name) { return fits(one, name); });
  });
  return chosen;
}

std::vector<Outcome> run_cases(std::span<const Case> cases, gpu::Device* device,
                               const std::function<void(std::size_t done)>& progress) {
  std::vector<Outcome> outcomes;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (progress) progress(i);
    const Result<Rows> rows = rows_from(cases[i], device);
    const std::string name(cases[i].name);
    if (!rows)
      outcomes.push_back({name,
                          {"could not be run: " + rows.error().message, 0.0,
                           std::numeric_limits<double>::quiet_NaN()}});
    else
      for (const Row& row : *rows) outcomes.push_back({name, row});
  }
  return outcomes;
}

int status_of(std::span<const Outcome> outcomes) {
  const bool all_pass = std::all_of(outcomes.begin(), outcomes.end(),
                                    [](const Outcome& one) { return one.row.pass(); });
  return all_pass && !outcomes.empty() ? kDone : kFailed;
}

std::string table_of(std::span<const Outcome> outcomes) {
  std::string text = "| case | quantity | bound | observed |\n|---|---|---|---|\n";
  for (const Outcome& one : outcomes)
    text += fmt::format("| {} | {} | {:.3g} | {:.3g}{} |\n", one.case_name, one.row.quantity,
                        one.row.bound, one.row.observed, one.row.pass() ? "" : " FAILED");
  return text;
}

nlohmann::ordered_json rows_of(std::span<const Outcome> outcomes) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Outcome& one : outcomes)
    rows.push_back({{"case", one.case_name},
                    {"quantity", one.row.quantity},
                    {"bound", one.row.bound},
                    {"observed", one.row.observed},
                    {"pass", one.row.pass()}});
  return rows;
}

}  // namespace skerry::tools::stability
