#include "tools/skerry/farm/verbs.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <ctime>

#include "engine/core/log.h"
#include "game/scene_file/parse.h"
#include "tools/skerry/scene/scene_device.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDir = "--dir";

/// What follows `COMMAND plan`, without --dir.
std::vector<std::string> arguments_of_plan(std::span<const std::string> typed) {
  std::vector<std::string> kept;
  for (std::size_t i = 2; i < typed.size(); ++i) {
    if (typed[i] == kDir) {
      ++i;
    } else if (!typed[i].starts_with(std::string(kDir) + "=")) {
      kept.push_back(typed[i]);
    }
  }
  return kept;
}

}  // namespace

Verbs::Verbs(CLI::App& command)
    : command_(command),
      plan_(command.add_subcommand("plan", "Write the list of tasks to DIR")),
      run_(command.add_subcommand("run", "Run tasks of the plan in DIR; write a row for each")),
      merge_(command.add_subcommand("merge", "Put the rows of DIR and other folders together")) {
  command.require_subcommand(0, 1);
  for (CLI::App* verb : {plan_, run_, merge_}) {
    verb->allow_extras();
    verb->footer("");
    verb->add_option(std::string(kDir), dir_, "Folder of the plan and of its rows")
        ->type_name("DIR")
        ->required();
  }
  run_->add_option("TASK", tasks_,
                   "Names, ids or I/N, each N-th task from the I-th on (default: all without a "
                   "row)");
  run_->add_option("--device", device_, "Vulkan device, as 'skerry devices' counts")
      ->type_name("N");
  merge_->add_option("FOLDER", folders_, "More folders with rows of the same plan");
}

const CLI::App* Verbs::chosen() const {
  for (const CLI::App* verb : {plan_, run_, merge_})
    if (verb->parsed()) return verb;
  return nullptr;
}

std::optional<Refusal> Verbs::check(const CLI::App& verb) const {
  if (auto refusal = check_leftovers(verb)) return refusal;
  for (const CLI::Option* option : command_.get_options()) {
    if (option->count() == 0 || option->get_name() == "--help") continue;
    return Refusal{kUsage,
                   {fmt::format("{} stands before {}: give it behind that",
                                game::quote_text(option->get_name()), verb.get_name())}};
  }
  return std::nullopt;
}

std::optional<Refusal> Verbs::write(std::span<const std::string> typed, std::vector<Task> tasks,
                                    std::vector<std::string> notes) const {
  const Plan plan{command_.get_name(), arguments_of_plan(typed), date_now(), std::move(tasks),
                  std::move(notes)};
  if (const Result<void> done = write_plan(dir_, plan); !done)
    return Refusal{kFailed, done.error()};
  fmt::print("{} tasks in {}\n", plan.tasks.size(), one_line(dir_));
  return std::nullopt;
}

std::optional<Refusal> Verbs::read(Plan& plan) const {
  Result<Plan> found = read_plan(dir_, command_.get_name());
  if (!found) return Refusal{kFailed, found.error()};
  plan = *std::move(found);
  return std::nullopt;
}

std::optional<Refusal> Verbs::to_run(const Plan& plan, std::vector<std::size_t>& tasks) const {
  Result<std::vector<std::size_t>> chosen = chosen_tasks(plan, tasks_);
  if (!chosen) return Refusal{kUsage, chosen.error()};
  tasks = *std::move(chosen);
  // A share is what a scheduler starts again after a node was lost: what is done stays done.
  const bool by_name = std::ranges::any_of(tasks_, [&](const std::string& word) {
    return std::ranges::any_of(
        plan.tasks, [&](const Task& task) { return task.id == word || task.name == word; });
  });
  if (by_name) return std::nullopt;
  std::erase_if(tasks, [&](std::size_t i) {
    std::error_code code;
    return fs::exists(record_file(dir_, plan.tasks[i].id), code);
  });
  return std::nullopt;
}

std::optional<Refusal> Verbs::read_rows(const Plan& plan, Collected& rows) const {
  std::vector<fs::path> folders{dir_};
  std::error_code code;
  for (const std::string& folder : folders_) {
    if (!fs::is_directory(folder, code))
      return Refusal{kFailed,
                     {fmt::format("there is no folder {}: give folders that skerry {} run wrote",
                                  game::quote_text(folder), command_.get_name())}};
    if (std::ranges::none_of(
            folders, [&](const fs::path& known) { return fs::equivalent(known, folder, code); }))
      folders.emplace_back(folder);
  }
  Result<Collected> found = collect(plan, folders);
  if (!found) return Refusal{kFailed, found.error()};
  rows = *std::move(found);
  return std::nullopt;
}

Result<void> parse_again(CLI::App& app, const Plan& plan) {
  std::vector<std::string> words{plan.command, "plan", std::string(kDir), "."};
  words.insert(words.end(), plan.arguments.begin(), plan.arguments.end());
  std::ranges::reverse(words);  // as CLI11 wants it
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    return Error{fmt::format("cannot use the plan: {}; make it again with this program",
                             game::quote_text(error.what()))};
  }
  return {};
}

bool print_faults(const Plan& plan, const Collected& rows) {
  bool any = false;
  for (std::size_t i = 0; i < plan.tasks.size(); ++i) {
    if (rows.faults[i].empty()) continue;
    any = true;
    fmt::print("{}: {}\n", one_line(plan.tasks[i].name), one_line(rows.faults[i]));
  }
  return any;
}

std::string date_now() {
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
}

}  // namespace skerry::tools
