#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/skerry/compare/baseline.h"
#include "tools/skerry/farm/devices.h"
#include "tools/skerry/farm/verbs.h"
#include "tools/skerry/report/report_folder.h"
#include "tools/skerry/scene/arguments.h"
#include "tools/skerry/test/approve_command.h"
#include "tools/skerry/test/history.h"
#include "tools/skerry/test/pool.h"

namespace CLI {
class App;
}

namespace skerry::tools {

/// `skerry test`: draws scenes and judges them by their references (docs/testing.md). `test
/// plan|run|merge` does the same in parts (docs/farm.md).
class TestCommand {
 public:
  /// Adds `test` and its options.
  explicit TestCommand(CLI::App& app);
  TestCommand(const TestCommand&) = delete;
  TestCommand& operator=(const TestCommand&) = delete;

  const CLI::App* command() const { return test_; }
  /// @pre `test` was given. @param typed all arguments. @return the exit status.
  int run(std::span<const std::string> typed);

 private:
  void add_drawing_options(CLI::App& command);
  void add_output_options(CLI::App& command);
  void add_jobs(CLI::App& command);
  std::optional<Refusal> check_typed();
  std::optional<Refusal> check_outputs();
  int draw_and_judge();
  Result<void> store_approved(std::span<const TestScene> scenes,
                              std::span<const Outcome> outcomes) const;
  int merge_shards();
  int compare_pictures();
  int write_plan(std::span<const std::string> typed);
  int run_tasks();
  std::optional<Refusal> read_planned(const Plan& plan, std::vector<TestScene>& scenes);
  int merge_rows();
  PoolResult draw(const std::vector<TestScene>& scenes,
                  const std::function<Result<void>(std::size_t, const Outcome&)>& finished) const;
  std::optional<Refusal> read_set(std::vector<TestScene>& scenes, std::size_t& in_set) const;
  Result<void> write_outputs(Results results, const std::optional<std::string>& date = {});
  Result<void> copy_pictures(const std::vector<Results>& shards) const;
  Result<void> copy_pictures_of(const std::string& scene, const std::filesystem::path& from) const;

  CLI::App* test_;
  std::unique_ptr<Verbs> verbs_;
  std::unique_ptr<ApproveCommand> approve_command_;
  std::vector<std::string> paths_;
  std::optional<std::string> shard_text_, html_, json_, junit_, device_text_, devices_text_,
      jobs_text_, repeat_text_, tolerance_text_, baseline_, history_path_;
  bool approve_ = false, merge_ = false, compare_ = false, validate_ = false;
  Shard shard_;
  PoolOptions pool_;
  std::optional<Baseline> opened_baseline_;  // for baseline_
  std::optional<ReportFolder> report_;       // for html_
  std::optional<History> history_;           // for history_path_
};

}  // namespace skerry::tools
