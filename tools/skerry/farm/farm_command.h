#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/skerry/farm/plan.h"
#include "tools/skerry/farm/slurm.h"
#include "tools/skerry/scene/arguments.h"

namespace CLI {
class App;
}

namespace skerry::tools {

/// `skerry farm`: runs the tasks of a plan as jobs of Slurm (docs/farm.md). What is submitted are
/// the commands `run` and `merge` of the plan's own command.
class FarmCommand {
 public:
  /// Adds `farm` and its sub-commands.
  explicit FarmCommand(CLI::App& app);
  FarmCommand(const FarmCommand&) = delete;
  FarmCommand& operator=(const FarmCommand&) = delete;

  const CLI::App* command() const { return farm_; }
  /// @pre `farm` was given. @return the exit status.
  int run();

 private:
  CLI::App* add(const char* name, const char* description);
  std::optional<Refusal> read();
  std::optional<Refusal> read_submit();
  std::optional<Refusal> read_queue(Queue& queue) const;
  int submit();
  int submit_jobs(const JobArray& array) const;
  int status();
  int fetch();

  CLI::App* farm_;
  CLI::App *submit_, *status_, *fetch_;
  std::string dir_text_;
  std::optional<std::string> tasks_text_, cpus_text_, to_;
  bool dry_run_ = false;
  JobRequest request_;

  std::filesystem::path dir_;  ///< absolute
  Plan plan_;
  std::vector<std::size_t> missing_;  ///< tasks without a row
  std::size_t tasks_per_job_ = 0;     ///< 0: so many that there are 1000 jobs at most
  Submitted submitted_;               ///< last
};

}  // namespace skerry::tools
