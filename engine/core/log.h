#pragma once
#include <string>
#include <string_view>

namespace skerry {

/// Text of others (names of files, messages of drivers) for one line: control characters as \xNN.
std::string one_line(std::string_view text);

/// Each call writes one line `skerry: [warning: ]text` to stderr, whole even when several threads
/// log at once. Standard output stays free for what was asked for.
void log_error(std::string_view text);
void log_warning(std::string_view text);
void log_info(std::string_view text);

}  // namespace skerry
