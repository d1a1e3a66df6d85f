#pragma once
#include <filesystem>
#include <string>

#include "tools/skerry/test/history.h"
#include "tools/skerry/test/rows.h"

namespace skerry::tools {

/// The report of a test as one HTML page beside its pictures (report_pictures.h):
/// failures first, then what was approved, then the rest. Shows those pictures that `folder` holds.
/// @param history that has these rows as well; nullptr: none is kept.
std::string test_page(const Results& results, const std::filesystem::path& folder,
                      const History* history = nullptr);

}  // namespace skerry::tools
