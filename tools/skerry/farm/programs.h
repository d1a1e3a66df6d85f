// Other programs, run and waited for.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/result.h"

namespace skerry::tools {

/// What a program left behind.
struct ProgramEnd {
  int status = 0;        ///< its exit status; 128 and the signal's number if one ended it
  std::string out, err;  ///< all it wrote
};

/// Runs a program, looked up in PATH, without input, and waits for it.
/// Errors: it cannot be started; they say which and why.
Result<ProgramEnd> run_program(std::vector<std::string> words);

/// The file of this program. Errors: the kernel does not say.
Result<std::filesystem::path> own_program();

/// Becomes another program; returns only what kept it from that.
Error become_program(std::vector<std::string> words);

/// The last line of a text that is not empty, for an error of one line.
std::string last_line(const std::string& text);

}  // namespace skerry::tools
