// Pictures of two folders against each other, whichever programs drew them.
#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "engine/core/result.h"
#include "game/scene_file/expectations.h"
#include "tools/skerry/test/rows.h"

namespace skerry::tools {

struct CompareOptions {
  std::filesystem::path reference, actual;  ///< folders of *.png (not below them)
  game::Expectations expected;
  std::optional<std::filesystem::path> html;  ///< folder that gets the pictures of the report
};

/// Compares each *.png of one folder with that of the same name in the other, on all cores.
/// @return a row a name, sorted; a picture that is in one folder alone, cannot be read or has
/// another size fails, as does one that the tolerance does not fit. Errors: what is no folder;
/// neither has a picture.
Result<std::vector<Row>> compare_folders(const CompareOptions& options);

}  // namespace skerry::tools
