#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/skerry/report/report_session.h"
#include "tools/skerry/scene/arguments.h"

namespace skerry::tools {

/// `skerry report [TOPIC]... --out DIR`: errors against run time.
class ReportCommand {
 public:
  /// Adds `report`.
  explicit ReportCommand(CLI::App& app);
  ReportCommand(const ReportCommand&) = delete;
  ReportCommand& operator=(const ReportCommand&) = delete;

  const CLI::App* command() const { return report_; }
  /// @pre `report` was given. @param typed all arguments, for the report to say them.
  /// @return the exit status.
  int run(std::span<const std::string> typed);

 private:
  std::optional<Refusal> read(std::span<const std::string> typed, ReportRequest& request) const;
  std::optional<Refusal> read_topics(ReportRequest& request) const;

  CLI::App* report_;
  std::vector<std::string> topics_;
  std::optional<std::string> out_;
  SceneArguments scene_;
};

/// Measures and writes. @return the exit status.
int report(const ReportRequest& request);

}  // namespace skerry::tools
