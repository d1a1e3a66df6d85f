#pragma once
#include <filesystem>
#include <string_view>

#include "engine/core/result.h"

namespace skerry::tools {

/// The file that makes a folder a report.
inline constexpr std::string_view kReportFile = "report.json";

/// A folder that appears under its name when it is finished, and not at all when it is not: it is
/// filled under a name beside it.
class ReportFolder {
 public:
  /// Creates the folder to fill. Errors: `dir` exists and is neither an empty folder nor a report;
  /// its parent is missing or not writable.
  static Result<ReportFolder> create(const std::filesystem::path& dir);
  ~ReportFolder();  ///< removes what was not published
  ReportFolder(ReportFolder&& other) noexcept;
  ReportFolder& operator=(ReportFolder&&) = delete;

  /// The folder to fill.
  const std::filesystem::path& path() const { return filling_; }
  /// Gives the folder its name, in the place of the report that was there.
  Result<void> publish();

 private:
  ReportFolder(std::filesystem::path dir, std::filesystem::path filling);

  std::filesystem::path dir_, filling_;  // filling_ is empty when published
};

}  // namespace skerry::tools
