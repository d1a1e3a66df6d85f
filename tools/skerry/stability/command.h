#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/skerry/farm/verbs.h"
#include "tools/skerry/stability/run.h"

namespace CLI {
class App;
}

namespace skerry::tools {

/// `skerry stability [--json FILE] [--device N] [--validate] [--list] [CASE]...`: extremes against
/// bounds. `stability plan|run|merge` does the same in parts (docs/farm.md).
class StabilityCommand {
 public:
  /// Adds `stability`.
  explicit StabilityCommand(CLI::App& app);
  StabilityCommand(const StabilityCommand&) = delete;
  StabilityCommand& operator=(const StabilityCommand&) = delete;

  const CLI::App* command() const { return command_; }
  /// @pre `stability` was given. @param typed all arguments. @return the exit status.
  int run(std::span<const std::string> typed);

 private:
  void add_options(CLI::App& command);
  std::optional<Refusal> read(std::vector<stability::Case>& cases) const;
  int run_here();
  int write_plan(std::span<const std::string> typed);
  int run_tasks();
  int merge();
  std::optional<Refusal> open(std::span<const stability::Case> cases,
                              std::unique_ptr<gpu::Device>& device) const;
  int conclude(const Collected& rows, double processor_s) const;

  CLI::App* command_;
  std::unique_ptr<Verbs> verbs_;
  std::vector<std::string> cases_;
  std::optional<std::string> json_, device_;
  bool validate_ = false, list_ = false;
};

}  // namespace skerry::tools
