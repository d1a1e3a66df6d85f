#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/skerry/report/report_folder.h"
#include "tools/skerry/scene/arguments.h"
#include "tools/skerry/test/pool.h"

namespace skerry::tools {

/// `skerry test`: draws scenes and judges them by their references (docs/testing.md).
class TestCommand {
 public:
  /// Adds `test` and its options.
  explicit TestCommand(CLI::App& app);
  TestCommand(const TestCommand&) = delete;
  TestCommand& operator=(const TestCommand&) = delete;

  const CLI::App* command() const { return test_; }
  /// @pre `test` was given. @return the exit status.
  int run();

 private:
  std::optional<Refusal> check_typed();
  std::optional<Refusal> check_outputs();
  int draw_and_judge();
  int merge_shards();
  std::optional<Refusal> read_set(std::vector<TestScene>& scenes, std::size_t& in_set) const;
  Result<void> approve(const std::vector<TestScene>& scenes,
                       const std::vector<Outcome>& outcomes) const;
  Result<void> write_outputs(Results results);
  Result<void> copy_pictures(const std::vector<Results>& shards) const;

  CLI::App* test_;
  std::vector<std::string> paths_;
  std::optional<std::string> shard_text_, html_, json_, junit_, device_text_, jobs_text_,
      repeat_text_;
  bool approve_ = false, merge_ = false, validate_ = false;
  Shard shard_;
  PoolOptions pool_;
  std::optional<ReportFolder> report_;  // for html_
};

}  // namespace skerry::tools
