#pragma once
#include <string>
#include <vector>

namespace skerry::tools {

/// Runs the command that `typed`, a program's arguments, name; without one, play. @return the exit
/// status.
int run_command_line(std::vector<std::string> typed);

}  // namespace skerry::tools
