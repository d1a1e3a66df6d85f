#include "tools/skerry/stability/command.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <memory>

#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/scene/arguments.h"
#include "tools/skerry/scene/progress.h"
#include "tools/skerry/scene/scene_device.h"
#include "tools/skerry/stability/run.h"

namespace skerry::tools {
StabilityCommand::StabilityCommand(CLI::App& app)
    : command_(app.add_subcommand("stability", "Run extremes against their bounds")) {
  command_->allow_extras();
  command_->footer("");
  command_->add_option("CASE", cases_, "Cases or groups to run (default: all)");
  command_->add_option("--json", json_, "Write the rows as JSON")->type_name("FILE");
  command_->add_option("--device", device_, "Vulkan device, as 'skerry devices' counts")
      ->type_name("N");
  command_->add_flag("--validate", validate_, "Turn the Vulkan validation layer on");
  command_->add_flag("--list", list_, "Print the names of the cases and stop");
}

int StabilityCommand::run() {
  if (const auto refusal = check_leftovers(*command_)) return fail(refusal->status, refusal->error);
  const std::vector<stability::Case> all = stability::all_cases();
  const Result<std::vector<stability::Case>> cases = stability::chosen_cases(all, cases_);
  if (!cases) return fail(kUsage, cases.error());
  game::SceneOptions scene;
  if (const auto refusal = parse_device(device_, scene.device))
    return fail(refusal->status, refusal->error);
  if (const auto refusal = check_output(json_)) return fail(refusal->status, refusal->error);
  if (list_) {
    for (const stability::Case& one : *cases) fmt::print("{}\n", one.name);
    return kDone;
  }
  scene.validate = validate_;
  std::unique_ptr<gpu::Device> device;
  // One that was asked for has to be there, even if no case draws on it.
  if (device_ || validate_ || std::any_of(cases->begin(), cases->end(), [](const auto& one) {
        return one.needs_device();
      })) {
    Result<std::unique_ptr<gpu::Device>> opened = open_device(scene);
    if (!opened) return fail(kNoDevice, opened.error());
    device = *std::move(opened);
  }
  std::vector<stability::Outcome> outcomes;
  {
    ProgressBar bar;
    outcomes = stability::run_cases(*cases, device.get(), [&](std::size_t done) {
      bar.show(static_cast<double>(done) / static_cast<double>(cases->size()), (*cases)[done].name);
    });
  }
  fmt::print("{}", stability::table_of(outcomes));
  const auto failed = std::count_if(outcomes.begin(), outcomes.end(),
                                    [](const auto& one) { return !one.row.pass(); });
  // Of all threads, the driver's among them.
  const double processor_s = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  fmt::print("\n{} rows, {} failed, {:.0f} s of processor time{}\n", outcomes.size(), failed,
             processor_s,
             device ? fmt::format(", on {}, {}", device->info().name, device->info().driver)
                    : std::string());
  std::optional<std::filesystem::path> file;
  if (json_) file = *json_;
  if (Result<void> written = write_rows(file, stability::rows_of(outcomes)); !written)
    return fail(kFailed, written.error());
  if (device && device->validation_message_count() > 0) return status_after(*device);
  return stability::status_of(outcomes);
}

}  // namespace skerry::tools
