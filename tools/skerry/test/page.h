#pragma once
#include <filesystem>
#include <string>

#include "tools/skerry/test/history.h"
#include "tools/skerry/test/rows.h"

namespace skerry::tools {

/// The report of a test as one HTML page: failures first, then what was approved, then the rest. It
/// holds the pictures of `folder` (report_pictures.h), in this order, as long as they are not more
/// than 48 MiB; of the rest it shows the files, beside which it lies.
/// @param history that has these rows as well; nullptr: none is kept.
std::string test_page(const Results& results, const std::filesystem::path& folder,
                      const History* history = nullptr);

}  // namespace skerry::tools
