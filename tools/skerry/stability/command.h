#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace skerry::tools {

/// `skerry stability [--json FILE] [--device N] [--validate] [--list] [CASE]...`: extremes against
/// bounds.
class StabilityCommand {
 public:
  /// Adds `stability`.
  explicit StabilityCommand(CLI::App& app);
  StabilityCommand(const StabilityCommand&) = delete;
  StabilityCommand& operator=(const StabilityCommand&) = delete;

  const CLI::App* command() const { return command_; }
  /// @pre `stability` was given. @return the exit status.
  int run();

 private:
  CLI::App* command_;
  std::vector<std::string> cases_;
  std::optional<std::string> json_, device_;
  bool validate_ = false, list_ = false;
};

}  // namespace skerry::tools
