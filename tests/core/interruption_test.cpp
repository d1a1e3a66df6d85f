#include "engine/core/interruption.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/core/clock.h"

namespace skerry {
namespace {

TEST(DoneWhenInterrupted, WorkThatDoesNotEndIsGivenUp) {
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const DoneWhenInterrupted endless([]() -> bool {
      while (true) ::pause();
    });
    if (::write(ready[1], "x", 1) != 1) ::_exit(9);
    ::alarm(20);
    while (true) ::pause();  // sleep() would end with the signal
  }
  char byte = 0;
  EXPECT_EQ(::read(ready[0], &byte, 1), 1);
  ::close(ready[0]);
  ::close(ready[1]);
  const Stopwatch since_signal;
  ::kill(child, SIGTERM);
  int status = 0;
  ::waitpid(child, &status, 0);
  // It has two seconds, and a busy machine as long again to end the process.
  EXPECT_GE(since_signal.seconds(), 1.5);
  EXPECT_LT(since_signal.seconds(), 4.0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << status;
}

}  // namespace
}  // namespace skerry
