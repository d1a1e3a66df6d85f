// Runs the program itself, as scripts do.
#pragma once
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <test_paths.h>
#include "tests/folder.h"

namespace skerry {

/// What a run of the program left behind.
struct Outcome {
  int status = -1;
  std::string out, err;
};

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Runs `skerry arguments...`; `environment` holds NAME=VALUE, or NAME to unset.
/// @param program another one of the build folder.
inline Outcome run(std::vector<std::string> arguments,
                   const std::vector<std::string>& environment = {},
                   const std::string& program = "skerry") {
  const Folder folder;
  const std::filesystem::path out = folder / "out", err = folder / "err";
  arguments.insert(arguments.begin(), SKERRY_BINARY_DIR "/" + program);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), 1);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), 2);
    for (const std::string& entry : environment) {
      const std::size_t equals = entry.find('=');
      if (equals == std::string::npos) {
        ::unsetenv(entry.c_str());
      } else {
        ::setenv(entry.substr(0, equals).c_str(), entry.substr(equals + 1).c_str(), 1);
      }
    }
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_of(out),
          text_of(err)};
}

/// One line `skerry: ...` on stderr, with all of `parts` in it, and this status.
inline void expect_refusal(const Outcome& outcome, int status,
                           const std::vector<std::string>& parts, const std::string& what) {
  EXPECT_EQ(outcome.status, status) << what << ": " << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with("skerry: ")) << what << ": " << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1)
      << what << ": " << outcome.err;
  for (const std::string& part : parts)
    EXPECT_NE(outcome.err.find(part), std::string::npos) << what << ": " << outcome.err;
}

}  // namespace skerry
