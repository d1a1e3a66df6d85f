#include "engine/core/log.h"

#include <fmt/format.h>

#include <cstdio>
#include <string>

namespace skerry {
namespace {

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 32 || c == 127;
}

// One fwrite a line: stdio locks the stream for the call, so lines of several threads never mix.
void write_line(std::string_view prefix, std::string_view text) {
  const std::string line = fmt::format("{}{}\n", prefix, one_line(text));
  std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

std::string one_line(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (is_control(c)) {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      out += c;
    }
  }
  return out;
}

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
