#include "engine/core/log.h"

#include <cstdio>
#include <string>

namespace skerry {
namespace {

// One fwrite a line: stdio locks the stream for the call, so lines of several threads never mix.
void write_line(std::string_view prefix, std::string_view text) {
  std::string line;
  line.reserve(prefix.size() + text.size() + 1);
  line.append(prefix).append(text).push_back('\n');
  std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

void log_error(std::string_view text) {
  write_line("skerry: ", text);
}
void log_warning(std::string_view text) {
  write_line("skerry: warning: ", text);
}
void log_info(std::string_view text) {
  write_line("skerry: ", text);
}

}  // namespace skerry
