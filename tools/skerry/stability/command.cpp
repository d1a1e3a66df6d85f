#include "tools/skerry/stability/command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <ctime>
#include <memory>

#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/scene/arguments.h"
#include "tools/skerry/scene/progress.h"
#include "tools/skerry/scene/scene_device.h"
#include "tools/skerry/stability/records.h"

namespace skerry::tools {
namespace {

/// Of all threads, the driver's among them.
double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace

StabilityCommand::StabilityCommand(CLI::App& app)
    : command_(app.add_subcommand("stability", "Run extremes against their bounds")) {
  command_->allow_extras();
  command_->footer("");
  verbs_ = std::make_unique<Verbs>(*command_);
  add_options(*command_);
  add_options(verbs_->plan());
  command_->add_flag("--list", list_, "Print the names of the cases and stop");
  for (CLI::App* command : {command_, &verbs_->merge()})
    command->add_option("--json", json_, "Write the rows as JSON")->type_name("FILE");
}

/// What decides the rows.
void StabilityCommand::add_options(CLI::App& command) {
  command.add_option("CASE", cases_, "Cases or groups to run (default: all)");
  command.add_option("--device", device_, "Vulkan device, as 'skerry devices' counts")
      ->type_name("N");
  command.add_flag("--validate", validate_, "Turn the Vulkan validation layer on");
}

int StabilityCommand::run(std::span<const std::string> typed) {
  if (!verbs_->chosen()) return run_here();
  if (const auto refusal = verbs_->check(*verbs_->chosen())) return refuse(*refusal);
  if (verbs_->chosen() == &verbs_->plan()) return write_plan(typed);
  return verbs_->chosen() == &verbs_->run() ? run_tasks() : merge();
}

std::optional<Refusal> StabilityCommand::read(std::vector<stability::Case>& cases) const {
  std::optional<std::uint32_t> device;
  Result<std::vector<stability::Case>> chosen =
      stability::chosen_cases(stability::all_cases(), cases_);
  if (!chosen) return Refusal{kUsage, chosen.error()};
  cases = *std::move(chosen);
  return parse_device(device_, device);
}

/// Opens the device that cases need. One that was asked for has to be there, even if no case draws
/// on it.
std::optional<Refusal> StabilityCommand::open(std::span<const stability::Case> cases,
                                              std::unique_ptr<gpu::Device>& device) const {
  const bool needed =
      std::ranges::any_of(cases, [](const stability::Case& one) { return one.needs_device(); });
  if (!needed && !device_ && !validate_) return std::nullopt;
  game::SceneOptions scene;
  if (auto refusal = parse_device(device_, scene.device)) return refusal;
  scene.validate = validate_;
  Result<std::unique_ptr<gpu::Device>> opened = open_device(scene);
  if (!opened) return Refusal{kNoDevice, opened.error()};
  device = *std::move(opened);
  return std::nullopt;
}

int StabilityCommand::run_here() {
  if (const auto refusal = check_leftovers(*command_)) return refuse(*refusal);
  std::vector<stability::Case> cases;
  if (const auto refusal = read(cases)) return refuse(*refusal);
  if (const auto refusal = check_output(json_)) return refuse(*refusal);
  if (list_) {
    for (const stability::Case& one : cases) fmt::print("{}\n", one.name);
    return kDone;
  }
  std::unique_ptr<gpu::Device> device;
  if (const auto refusal = open(cases, device)) return refuse(*refusal);
  Collected rows;
  {
    ProgressBar bar;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      bar.show(static_cast<double>(i) / static_cast<double>(cases.size()), cases[i].name);
      rows.records.emplace_back(stability::run_case(cases[i], {}, device.get()));
    }
  }
  const int status = conclude(rows, processor_seconds());
  if (device && device->validation_message_count() > 0) return status_after(*device);
  return status;
}

int StabilityCommand::write_plan(std::span<const std::string> typed) {
  std::vector<stability::Case> cases;
  if (const auto refusal = read(cases)) return refuse(*refusal);
  const Result<std::vector<Task>> tasks = stability::tasks_of(cases, validate_);
  if (!tasks) return fail(kFailed, tasks.error());
  if (const auto refusal = verbs_->write(typed, *tasks)) return refuse(*refusal);
  return kDone;
}

int StabilityCommand::run_tasks() {
  Plan plan;
  if (const auto refusal = verbs_->read(plan)) return refuse(*refusal);
  CLI::App app;
  StabilityCommand planned(app);
  if (const Result<void> parsed = parse_again(app, plan); !parsed)
    return fail(kFailed, parsed.error());
  if (verbs_->device()) planned.device_ = verbs_->device();
  std::vector<stability::Case> cases;
  if (const auto refusal = planned.read(cases)) return refuse(*refusal);
  const Result<std::vector<Task>> tasks = stability::tasks_of(cases, planned.validate_);
  if (!tasks) return fail(kFailed, tasks.error());
  if (const Result<void> same = check_same_tasks(plan, *tasks); !same)
    return fail(kFailed, same.error());
  std::vector<std::size_t> chosen;
  if (const auto refusal = verbs_->to_run(plan, chosen)) return refuse(*refusal);
  std::vector<stability::Case> wanted;
  for (const std::size_t i : chosen) wanted.push_back(cases[i]);
  std::unique_ptr<gpu::Device> device;
  if (const auto refusal = planned.open(wanted, device)) return refuse(*refusal);
  for (const std::size_t i : chosen) {
    const Record record = stability::run_case(cases[i], plan.tasks[i].id, device.get());
    if (const Result<void> written = write_record(verbs_->dir(), record); !written)
      return fail(kFailed, written.error());
    fmt::print("{}\n", plan.tasks[i].name);
    std::fflush(stdout);
  }
  return device ? status_after(*device) : kDone;
}

int StabilityCommand::merge() {
  Plan plan;
  if (const auto refusal = verbs_->read(plan)) return refuse(*refusal);
  if (const auto refusal = check_output(json_)) return refuse(*refusal);
  Collected rows;
  if (const auto refusal = verbs_->read_rows(plan, rows)) return refuse(*refusal);
  double processor_s = 0.0;
  for (const std::optional<Record>& record : rows.records)
    if (record) processor_s += measured_number(*record, "processor_s");
  const int status = conclude(rows, processor_s);
  return print_faults(plan, rows) ? kFailed : status;
}

/// Prints and writes all rows. @return the exit status that they ask for.
int StabilityCommand::conclude(const Collected& rows, double processor_s) const {
  std::vector<stability::Outcome> outcomes;
  std::string on;
  for (const std::optional<Record>& record : rows.records) {
    if (!record) continue;
    const Result<std::vector<stability::Outcome>> some = stability::outcomes_from(*record);
    if (!some) return fail(kFailed, some.error());
    outcomes.insert(outcomes.end(), some->begin(), some->end());
    if (!record->device.empty()) on = fmt::format(", on {}, {}", record->device, record->driver);
  }
  fmt::print("{}", stability::table_of(outcomes));
  const auto failed =
      std::ranges::count_if(outcomes, [](const auto& one) { return !one.row.pass(); });
  fmt::print("\n{} rows, {} failed, {:.0f} s of processor time{}\n", outcomes.size(), failed,
             processor_s, on);
  std::optional<std::filesystem::path> file;
  if (json_) file = *json_;
  if (Result<void> written = write_rows(file, stability::rows_of(outcomes)); !written)
    return fail(kFailed, written.error());
  return stability::status_of(outcomes);
}

}  // namespace skerry::tools
