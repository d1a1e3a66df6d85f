// Ctrl-C while a command makes its output: nothing is left of it.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include <test_paths.h>
#include "tests/folder.h"

namespace skerry {
namespace {

TEST(Interruption, LeavesNothingOfAReportBehind) {
  for (const int signal_number : {SIGINT, SIGTERM}) {
    const Folder folder;
    const std::string out = (folder / "report").string();
    const pid_t child = ::fork();
    if (child == 0) {
      const char* const program = SKERRY_BINARY_DIR "/skerry";
      ::execl(program, program, "report", "water_layers", "--size", "64x36", "--out", out.c_str(),
              nullptr);
      ::_exit(127);
    }
    int status = 0;
    while (std::filesystem::is_empty(folder.path()) && ::waitpid(child, &status, WNOHANG) == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the folder is there, and known
    ASSERT_EQ(::kill(child, signal_number), 0);
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal_number) << status;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
}

}  // namespace
}  // namespace skerry
