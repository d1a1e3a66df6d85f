#pragma once
#include <filesystem>
#include <string>

#include "engine/core/result.h"

namespace skerry::game {

/// Checks that a file is the one that somebody means.
/// @param expected its SHA-256, 64 lower-case digits.
/// Errors: it is another file; it cannot be read. One line with the file's name.
Result<void> check_sum(const std::filesystem::path& path, const std::string& expected);

}  // namespace skerry::game
