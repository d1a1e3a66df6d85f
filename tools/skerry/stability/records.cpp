#include "tools/skerry/stability/records.h"

#include <fmt/format.h>

#include <ctime>

#include "game/scene_file/parse.h"

namespace skerry::tools::stability {

using nlohmann::ordered_json;

Result<std::vector<Task>> tasks_of(std::span<const Case> cases, bool validate) {
  std::vector<Task> tasks;
  const std::string inputs[] = {validate ? "validate" : ""};
  for (const Case& one : cases) {
    Result<std::string> id = task_id("stability", one.name, inputs);
    if (!id) return id.error();
    tasks.push_back({*std::move(id), std::string(one.name)});
  }
  return tasks;
}

Record run_case(const Case& one, const std::string& task, gpu::Device* device) {
  const std::clock_t start = std::clock();
  const std::vector<Outcome> outcomes = run_cases({&one, 1}, device, {});
  Record record{task, {}, {}, ordered_json::array(), {}};
  for (const Outcome& outcome : outcomes)
    record.result.push_back({{"case", outcome.case_name},
                             {"quantity", outcome.row.quantity},
                             {"bound", any_number(outcome.row.bound)},
                             {"observed", any_number(outcome.row.observed)}});
  record.measured = {{"processor_s", static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC}};
  if (one.needs_device() && device) {
    record.device = device->info().name;
    record.driver = device->info().driver;
  }
  return record;
}

Result<std::vector<Outcome>> outcomes_from(const Record& record) {
  std::vector<Outcome> outcomes;
  try {
    for (const ordered_json& row : record.result)
      outcomes.push_back({row.at("case").get<std::string>(),
                          {row.at("quantity").get<std::string>(), any_number_from(row.at("bound")),
                           any_number_from(row.at("observed"))}});
  } catch (const ordered_json::exception& why) {
    return Error{fmt::format("cannot use the row {}: {}; plan and run its task again", record.task,
                             fault_of_row(why))};
  }
  return outcomes;
}

}  // namespace skerry::tools::stability
