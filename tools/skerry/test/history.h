// What earlier runs of scenes found: a file of rows that only grows, for the strips of a page.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/result.h"
#include "tools/skerry/test/rows.h"

namespace skerry::tools {

/// A run of one scene.
struct PastRun {
  std::string date;           ///< when, in UTC
  std::string scene, driver;  ///< as in its row
  Verdict verdict = Verdict::kFail;
  int runs = 1, failed_runs = 0, pictures = 0;
  std::string picture;  ///< SHA-256 of its pixels; empty: none, or a picture of another program
  std::optional<double> seconds;  ///< none: not noted by an earlier version
  bool operator==(const PastRun&) const = default;
};

PastRun past_run(const Row& row, const std::string& date);

/// Runs of one scene on one driver, in words: "12 runs: 10 passed, 2 failed; 3 different pictures".
std::string summary_of(std::span<const PastRun> runs);

/// A file of one JSON object a line. Others may append to it at the same time.
class History {
 public:
  /// Reads the file, or its last kMaxHistoryBytes; makes an empty one where there is none. Lines
  /// that are damaged are skipped, with one warning for all. Errors: it cannot be read or written;
  /// it is no regular file.
  static Result<History> open(std::filesystem::path file);

  /// The runs of a scene on a driver, oldest first.
  std::span<const PastRun> of(const std::string& scene, const std::string& driver) const;
  /// What the scene took when it was drawn last, on any driver; none: not known.
  std::optional<double> seconds_of(const std::string& scene) const;
  void add(PastRun run);
  /// The same, unless the run is there already: of rows that are merged once more.
  void add_new(PastRun run);
  /// Writes what was added, at once. A last line that a kill left unfinished gets an end first.
  /// Errors: the file cannot be written.
  Result<void> append();

 private:
  std::filesystem::path file_;
  std::map<std::pair<std::string, std::string>, std::vector<PastRun>> runs_;  // by scene and driver
  std::string unwritten_;                                                     // lines
};

/// What is read of a longer file; about 80,000 runs.
inline constexpr std::uint64_t kMaxHistoryBytes = std::uint64_t{1} << 24;

}  // namespace skerry::tools
