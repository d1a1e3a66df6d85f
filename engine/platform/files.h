#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "engine/core/result.h"

namespace skerry::platform {

/// Reads a whole file of at most `max_bytes`; a pipe or device, as long as all of it comes within
/// ten seconds. Errors: missing, a folder, a socket, unreadable, larger, slower.
Result<std::string> read_text(const std::filesystem::path& path, std::uint64_t max_bytes);

/// The user's folders for Skerry, by the XDG base directory rules: variable, else the default below
/// $HOME. Not created; make_dirs does that. Empty when
/// neither the variable nor $HOME is set.
std::filesystem::path cache_dir();
std::filesystem::path config_dir();
std::filesystem::path data_dir();
Result<void> make_dirs(const std::filesystem::path& dir);

}  // namespace skerry::platform
