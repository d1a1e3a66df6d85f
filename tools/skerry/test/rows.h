// What a test found out: a row a scene, and the files made of rows for other programs.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "tools/skerry/compare/verdict.h"
#include "tools/skerry/test/cause.h"
#include "tools/skerry/test/scene_set.h"

namespace skerry::tools {

enum class Verdict : std::uint8_t {
  kPass,
  kFail,
  kApproved  ///< the picture has become the reference
};
std::string_view verdict_name(Verdict verdict);
/// None: no verdict has the name.
std::optional<Verdict> verdict_of_name(std::string_view name);

/// One scene's result; of several runs, the first that failed.
struct Row {
  std::string scene;
  Verdict verdict = Verdict::kFail;
  std::string message;              ///< one line; empty when there is nothing to say
  std::optional<bool> hash_equal;   ///< none: no hash is approved for the driver, or no picture
  std::optional<Difference> found;  ///< none: there was nothing to compare
  std::vector<PartDifference> parts;
  std::optional<Shift> shift;
  std::optional<Cause> cause;  ///< none: it did not fail, or no channels are kept
  double seconds = 0.0;
  std::string driver;                   ///< key of approved hashes
  std::optional<std::uint32_t> device;  ///< that drew it, as `skerry devices` counts; none: unknown
  std::string command;                  ///< draws the picture again
  bool sound = false;  ///< there is a picture, finite, and not black unless it may be
  int runs = 1, failed_runs = 0;
  int pictures = 0;     ///< distinct ones over all runs
  std::string picture;  ///< SHA-256 of its pixels; empty: none was drawn

  bool failed() const { return verdict == Verdict::kFail; }
  /// The message, and the cause if one is known. One line.
  std::string explanation() const;
  /// Takes in the numbers of a comparison.
  void take(const Comparison& compared);
};

/// All rows of a run, sorted by scene.
struct Results {
  Shard shard;
  std::size_t scenes_in_set = 0;  ///< of all shards
  std::vector<Row> rows;
  std::string html;  ///< folder of the report's pictures, relative to the JSON file; empty: none
};

/// Numbers that were not measured, and the PSNR of equal pictures, are null.
nlohmann::ordered_json row_json(const Row& row);
/// Errors: not what row_json makes.
Result<Row> row_from_json(const nlohmann::json& json);

nlohmann::ordered_json results_json(const Results& results);
/// Reads what `skerry test --json` wrote. Errors name the file.
Result<Results> read_results(const std::filesystem::path& file);

/// One result of all shards of a set. Errors: a shard that is missing or there twice, shards of
/// different sets, a scene that is missing or there twice.
Result<Results> merge(std::span<const Results> shards);

/// JUnit's XML, as CI systems read it.
std::string junit_xml(const Results& results);

}  // namespace skerry::tools
