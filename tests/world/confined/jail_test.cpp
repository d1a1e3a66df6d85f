#include "world/confined/jail.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "tests/world/vdb/sample_files.h"
#include "world/vdb/worker.h"

namespace skerry::world {
namespace {

/// How a process ends that does something in jail; -1 where there are no jails.
int end_of(const std::function<void()>& deed) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (!enter_jail()) ::_exit(99);
    deed();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 99 ? -1 : status;
}

#define SKIP_WITHOUT_JAIL() \
  if (end_of([] {}) < 0) GTEST_SKIP() << "this system or build has no jail"

TEST(Jail, HoldsThoseWhoOpenConnectOrRun) {
  SKIP_WITHOUT_JAIL();
  const std::function<void()> deeds[] = {[] { ::open("/etc/passwd", O_RDONLY); },
                                         [] { ::open("skerry_jail", O_WRONLY | O_CREAT, 0600); },
                                         [] { ::socket(AF_INET, SOCK_STREAM, 0); },
                                         [] { ::execl("/bin/true", "/bin/true", nullptr); }};
  for (const auto& deed : deeds) {
    const int status = end_of(deed);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGSYS) << status;
  }
}

TEST(Jail, LetsNobodyForkOrUnlinkOrKill) {
  SKIP_WITHOUT_JAIL();
  const Folder folder;
  std::ofstream(folder / "mine") << "x";
  const std::string mine = (folder / "mine").string();
  const pid_t self = ::getpid();
  const int status = end_of([&] {
    const bool did = ::fork() >= 0 || ::unlink(mine.c_str()) == 0 || ::kill(self, 0) == 0;
    ::_exit(did ? 1 : 0);
  });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  EXPECT_TRUE(std::filesystem::exists(mine));
}

TEST(Jail, LeavesMemoryAndOpenFiles) {
  SKIP_WITHOUT_JAIL();
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const int status = end_of([&] {
    const std::string large(64 << 20, 'y');
    if (::write(ends[1], large.data(), 3) != 3) ::_exit(1);
  });
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  char seen[3] = {};
  EXPECT_EQ(::read(ends[0], seen, 3), 3);
  ::close(ends[0]);
  ::close(ends[1]);
}

/// Filters of system calls that a process is under: what runs this test may have one, too. -1: this
/// system does not tell.
int filters_of(const std::string& process) {
  std::ifstream file("/proc/" + process + "/status");
  const std::string name = "Seccomp_filters:";
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(name)) return std::atoi(line.c_str() + name.size());
  return -1;
}

/// A child process of this one that is in jail, or 0.
pid_t jailed_child() {
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream children(thread.path() / "children");
    for (pid_t child = 0; children >> child;)
      if (filters_of(std::to_string(child)) > filters_of("self")) return child;
  }
  return 0;
}

TEST(Jail, IsWhereFilesAreReadAndItsEndIsALine) {
  SKIP_WITHOUT_OPENVDB();
  SKIP_WITHOUT_JAIL();
  if (!std::filesystem::exists("/proc/self/task/" + std::to_string(::getpid()) + "/children"))
    GTEST_SKIP() << "this system does not list children";
  if (filters_of("self") < 0) GTEST_SKIP() << "this system does not count filters";
  int file[2];  // that never comes
  ASSERT_EQ(::pipe2(file, O_CLOEXEC), 0);
  Result<MemoryFile> answer = MemoryFile::create();
  ASSERT_TRUE(answer);
  std::string line;
  std::thread reader([&] {
    const Result<void> ran =
        run_confined(kOpenVdb, {"read"}, file[0], answer->descriptor(), 0, {}, {});
    line = ran ? "" : ran.error().message;
  });
  pid_t child = 0;
  for (int attempt = 0; attempt < 2000 && child == 0; ++attempt, ::usleep(5000))
    child = jailed_child();
  EXPECT_NE(child, 0);
  if (child != 0) ::kill(child, SIGSYS);  // as its own call of open() would
  ::close(file[1]);
  reader.join();
  ::close(file[0]);
  EXPECT_NE(line.find("do not trust it"), std::string::npos) << line;
}

}  // namespace
}  // namespace skerry::world
