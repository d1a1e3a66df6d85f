#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/skerry/compare/baseline.h"
#include "tools/skerry/scene/arguments.h"
#include "tools/skerry/test/scene_set.h"

namespace CLI {
class App;
}

namespace skerry::tools {

/// `skerry test approve`: applies decisions that the page of a test saved (docs/testing.md).
class ApproveCommand {
 public:
  /// Adds `approve` and its options to `test`.
  explicit ApproveCommand(CLI::App& test);
  ApproveCommand(const ApproveCommand&) = delete;
  ApproveCommand& operator=(const ApproveCommand&) = delete;

  const CLI::App& command() const { return *approve_; }
  /// @pre `approve` was given. @return the exit status.
  int run() const;

 private:
  std::optional<Refusal> read_scenes(const std::optional<Baseline>& baseline,
                                     std::vector<TestScene>& scenes) const;

  CLI::App* approve_;
  std::string file_;
  std::vector<std::string> paths_;
  std::optional<std::string> report_, baseline_;
};

}  // namespace skerry::tools
