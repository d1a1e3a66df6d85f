// The sub-commands plan, run and merge of a command that can be split (docs/farm.md).
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/skerry/farm/plan.h"
#include "tools/skerry/farm/record.h"
#include "tools/skerry/scene/arguments.h"

namespace CLI {
class App;
}

namespace skerry::tools {

class Verbs {
 public:
  /// Adds the three, and what they have in common.
  explicit Verbs(CLI::App& command);
  Verbs(const Verbs&) = delete;
  Verbs& operator=(const Verbs&) = delete;

  /// For options of the command itself.
  CLI::App& plan() { return *plan_; }
  CLI::App& run() { return *run_; }
  CLI::App& merge() { return *merge_; }
  /// The one that was given; nullptr: none.
  const CLI::App* chosen() const;
  /// What is wrong with the arguments of a sub-command that was given.
  std::optional<Refusal> check(const CLI::App& verb) const;

  std::filesystem::path dir() const { return dir_; }
  /// --device of `run`, as typed.
  const std::optional<std::string>& device() const { return device_; }

  /// Writes a plan of these tasks. @param typed all arguments of the program.
  std::optional<Refusal> write(std::span<const std::string> typed, std::vector<Task> tasks,
                               std::vector<std::string> notes = {}) const;
  std::optional<Refusal> read(Plan& plan) const;
  /// Indices of the tasks to run: those named; without names, those without a row in the folder.
  std::optional<Refusal> to_run(const Plan& plan, std::vector<std::size_t>& tasks) const;
  /// The rows of --dir and the other folders.
  std::optional<Refusal> read_rows(const Plan& plan, Collected& rows) const;

 private:
  CLI::App& command_;
  CLI::App *plan_, *run_, *merge_;
  std::string dir_;
  std::vector<std::string> tasks_, folders_;
  std::optional<std::string> device_;
};

/// Parses the arguments of a plan once more, into commands that have been added to `app`.
/// Errors: the plan was made by another version of the program.
Result<void> parse_again(CLI::App& app, const Plan& plan);

/// A line for each task that is missing or has two results. @return whether there is any.
bool print_faults(const Plan& plan, const Collected& rows);

/// "2026-11-23 07:00 UTC".
std::string date_now();

}  // namespace skerry::tools
