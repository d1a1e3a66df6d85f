#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/skerry/farm/devices.h"
#include "tools/skerry/farm/verbs.h"
#include "tools/skerry/report/report_tasks.h"
#include "tools/skerry/scene/arguments.h"

namespace CLI {
class App;
}

namespace skerry::tools {

/// `skerry report [TOPIC]... --out DIR`: errors against run time (docs/report.md). `report
/// plan|run|merge` does the same in parts (docs/farm.md).
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
  void add_options(CLI::App& command);
  std::optional<Refusal> read(ReportRequest& request, ReportTasks& tasks) const;
  std::optional<Refusal> read_topics(ReportRequest& request) const;
  int run_here(std::span<const std::string> typed);
  int write_plan(std::span<const std::string> typed);
  int run_planned();
  int run_on(const ReportRequest& request, std::span<const ReportTask> tasks,
             const NextTask& next) const;
  int merge();

  CLI::App* report_;
  std::unique_ptr<Verbs> verbs_;
  std::vector<std::string> topics_;
  std::optional<std::string> out_, references_, devices_, reference_parts_;
  SceneArguments scene_;
};

}  // namespace skerry::tools
