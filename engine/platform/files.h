#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/result.h"

namespace skerry::platform {

/// Writes a whole file: to a temporary name in the same folder, then renamed, so that a reader sees
/// the old file or the new one. Errors name the path and the reason; nothing is left behind.
Result<void> write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
Result<void> write_text(const std::filesystem::path& path, std::string_view text);

/// Whether write_file would get as far as writing. Leaves nothing behind and does not touch an
/// existing file.
Result<void> check_writable(const std::filesystem::path& path);

/// Reads a whole file of at most `max_bytes`. Errors: missing, a folder, unreadable, larger.
Result<std::string> read_text(const std::filesystem::path& path, std::uint64_t max_bytes);

/// The folder the running program is in.
std::filesystem::path executable_dir();

/// The user's folders for Skerry, by the XDG base directory rules: variable, else the default below
/// $HOME. Not created; write_file does not create folders either, make_dirs does. Empty when
/// neither the variable nor $HOME is set.
std::filesystem::path cache_dir();
std::filesystem::path config_dir();
std::filesystem::path data_dir();
Result<void> make_dirs(const std::filesystem::path& dir);

}  // namespace skerry::platform
