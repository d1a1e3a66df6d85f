#pragma once
#include <string_view>

namespace skerry {

/// Each call writes one line `skerry: [warning: ]text` to stderr, whole even when several threads
/// log at once. Standard output stays free for what was asked for.
void log_error(std::string_view text);
void log_warning(std::string_view text);
void log_info(std::string_view text);

}  // namespace skerry
