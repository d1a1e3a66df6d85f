#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/draft.h"
#include "engine/core/result.h"

namespace skerry::tools {

/// The file that makes a folder a report.
inline constexpr std::string_view kReportFile = "report.json";

/// A folder that appears under its name when it is finished, and not at all when it is not
/// (engine/core/draft.h).
class ReportFolder {
 public:
  /// Creates the folder to fill. Errors: `dir` exists and is neither an empty folder nor a report;
  /// its parent is missing or not writable. They name `option`, which `dir` was given to.
  static Result<ReportFolder> create(const std::filesystem::path& dir, std::string_view option);
  /// The folder to fill.
  std::filesystem::path path() const { return draft_.path(); }
  /// Gives the folder its name, in the place of the report that was there.
  Result<void> publish();

 private:
  ReportFolder(std::filesystem::path dir, std::string option, Draft draft);

  std::filesystem::path dir_;
  std::string option_;
  Draft draft_;
};

}  // namespace skerry::tools
