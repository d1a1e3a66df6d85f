// What `report`, `test` and `stability` will do, as a list of tasks that run alone, anywhere
// (docs/farm.md).
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"

namespace skerry::tools {

struct Task {
  std::string id;    ///< task_id: equal ids give equal rows on equal devices
  std::string name;  ///< unique in a plan: "day", "shadows.acne", "aa_samples/noon"
  bool operator==(const Task&) const = default;
};

struct Plan {
  std::string command;                 ///< "test", "report" or "stability"
  std::vector<std::string> arguments;  ///< that make the plan again, behind `COMMAND plan`
  std::string date;                    ///< when it was made, for pages
  std::vector<Task> tasks;
  std::vector<std::string> notes;  ///< what is not in it and why, for pages; a line each
};

/// Hash of what a task depends on: its command, its name, this program, and `inputs`, which are
/// what else decides its row but for the device. "t" and 24 hexadecimal digits.
/// Errors: this program's file cannot be read.
Result<std::string> task_id(std::string_view command, std::string_view name,
                            std::span<const std::string> inputs);

/// SHA-256 of a file's bytes; "none" for a file that is not there. Errors: it cannot be read.
Result<std::string> file_hash(const std::filesystem::path& file);

/// Writes DIR/plan.json; makes the folder. Rows in it stay: those of tasks that are in the new plan
/// as well count as run.
Result<void> write_plan(const std::filesystem::path& dir, const Plan& plan);
/// Errors: none there; not what write_plan writes; of another command than `command`, which may be
/// empty for any that has plans.
Result<Plan> read_plan(const std::filesystem::path& dir, std::string_view command);

/// Checks that a plan made again, here and now, is the plan: that nothing a task depends on has
/// changed. Errors name the first task that differs.
Result<void> check_same_tasks(const Plan& plan, std::span<const Task> again);

/// Indices of the tasks that `wanted` names: ids, names, or I/N for each N-th task from the I-th
/// on, which may be none; all without any. In the plan's order, each once. Errors: nothing of that
/// name; names the nearest.
Result<std::vector<std::size_t>> chosen_tasks(const Plan& plan,
                                              std::span<const std::string> wanted);

}  // namespace skerry::tools
