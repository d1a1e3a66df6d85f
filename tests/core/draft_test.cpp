#include "engine/core/draft.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <vector>

#include "tests/folder.h"

namespace skerry {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(Draft, TakesItsNameWhenPublishedAndGoesWhenNot) {
  const Folder folder;
  {
    Result<Draft> draft = Draft::create(folder / "world");
    ASSERT_TRUE(draft) << draft.error().message;
    write(draft->path(), "half");
    EXPECT_FALSE(fs::exists(folder / "world"));
  }
  EXPECT_EQ(entries(folder.path()), 0u);
  {
    Result<Draft> draft = Draft::create(folder / "world");
    ASSERT_TRUE(draft);
    write(draft->path(), "whole");
    ASSERT_TRUE(draft->publish());
  }
  EXPECT_EQ(entries(folder.path()), 1u);
  EXPECT_EQ(fs::file_size(folder / "world"), 5u);
}

TEST(Draft, SaysWhyItCannotBe) {
  const Folder folder;
  EXPECT_FALSE(Draft::create(folder / "missing" / "world"));
  Result<Draft> draft = Draft::create(folder / "world");
  ASSERT_TRUE(draft);
  EXPECT_FALSE(draft->publish());  // nothing was made
}

TEST(Draft, RemovesWhatKilledProcessesLeftButNothingThatIsAtWork) {
  const Folder folder;
  Result<Draft> at_work = Draft::create(folder / "world");
  ASSERT_TRUE(at_work);
  write(at_work->path(), "slow");
  const fs::path left = folder / ".world.draft.AbCdEf", other = folder / ".other.draft.AbCdEf";
  for (const fs::path& one : {left, other}) {
    fs::create_directory(one);
    write(one / "world", "left");
  }
  const Result<Draft> second = Draft::create(folder / "world");
  ASSERT_TRUE(second);
  EXPECT_FALSE(fs::exists(left));  // however young
  EXPECT_TRUE(fs::exists(at_work->path()));
  EXPECT_TRUE(fs::exists(other));
}

TEST(Draft, ManyProcessesAtTheSameNameTakeNoneOfEachOthersForAbandoned) {
  const Folder folder;
  std::vector<pid_t> children;
  for (int i = 0; i < 8; ++i) {
    children.push_back(::fork());
    if (children.back() != 0) continue;
    for (int round = 0; round < 200; ++round) {
      Result<Draft> draft = Draft::create(folder / "world");
      if (draft) write(draft->path(), "whole");
      if (!draft || !draft->publish()) ::_exit(1);
    }
    ::_exit(0);
  }
  for (const pid_t child : children) {
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(entries(folder.path()), 1u);
}

/// Makes a draft in a child process and sends it a signal meanwhile. @return its end.
int end_of_interrupted(const fs::path& name, int signal_number, bool ignores) {
  int ready[2];
  EXPECT_EQ(::pipe(ready), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(signal_number, ignores ? SIG_IGN : SIG_DFL);  // whatever this test was started with
    Result<Draft> draft = Draft::create(name);
    if (draft) write(draft->path(), "half");
    [[maybe_unused]] const ssize_t told = ::write(ready[1], "x", 1);
    if (!ignores) ::sleep(20);
    ::sleep(1);
    ::_exit(0);
  }
  char byte = 0;
  EXPECT_EQ(::read(ready[0], &byte, 1), 1);
  ::close(ready[0]);
  ::close(ready[1]);
  ::kill(child, signal_number);
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

TEST(Draft, GoesWhenItsProcessIsInterrupted) {
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
    const Folder folder;
    const int status = end_of_interrupted(folder / "world", signal_number, false);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal_number) << status;
    EXPECT_EQ(entries(folder.path()), 0u);
  }
}

TEST(Draft, StaysWhereTheSignalIsIgnored) {
  const Folder folder;
  const int status = end_of_interrupted(folder / "world", SIGHUP, true);
  EXPECT_TRUE(WIFEXITED(status)) << status;
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(Draft, AChildProcessLeavesItsParentsDraftAlone) {
  const Folder folder;
  const Result<Draft> draft = Draft::create(folder / "parents");
  ASSERT_TRUE(draft);
  const int status = end_of_interrupted(folder / "childs", SIGTERM, false);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_TRUE(fs::exists(draft->folder()));
  EXPECT_EQ(entries(folder.path()), 1u);
}

}  // namespace
}  // namespace skerry
