// A drawn picture against all that is known about its scene.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/skerry/test/hashes.h"
#include "tools/skerry/test/rows.h"

namespace skerry::tools {

/// What was drawn, and by what.
struct Shown {
  platform::PngImage picture;
  std::uint64_t non_finite = 0;  ///< pixels that were not finite in some pass
  std::string driver;            ///< driver_key
};

struct JudgeOptions {
  bool approve = false;
  std::optional<std::filesystem::path> html;  ///< folder that gets the pictures of the report
};

/// A row, and what approving it means for the hashes.
struct Outcome {
  Row row;
  std::string hash;       ///< of the picture; empty: there is none
  bool replaced = false;  ///< the reference picture is another one now
};

/// Judges a picture; with --approve, makes it the reference unless it is black without leave or not
/// finite. A foreign driver's picture within the tolerance only adds its hash: references are
/// drawn by one driver.
Outcome judge(const TestScene& scene, const Shown& shown, const Hashes& approved,
              const JudgeOptions& options);

/// Stores the hash of a picture that was approved; where the reference is another one now, takes
/// the scene's hash from other drivers that share it.
Result<void> store_hash(const TestScene& scene, const Outcome& outcome);

/// A row of a scene that could not be drawn.
Row failed_row(const TestScene& scene, std::string why);

}  // namespace skerry::tools
