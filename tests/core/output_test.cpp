#include "engine/core/output.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <thread>
#include <vector>

#include "engine/core/draft.h"
#include "tests/folder.h"

namespace skerry {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

mode_t mode_of(const fs::path& path) {
  struct stat info {};
  EXPECT_EQ(::lstat(path.c_str(), &info), 0) << path;
  return info.st_mode;
}

std::string read_all(int descriptor) {
  std::string text;
  char block[4096];
  for (ssize_t got; (got = ::read(descriptor, block, sizeof block)) > 0;)
    text.append(block, static_cast<std::size_t>(got));
  return text;
}

/// A draft of a file with this text, made and published: the way of outputs that a library writes.
Result<void> by_draft(const fs::path& name, const std::string& text) {
  Result<Draft> draft = Draft::create(name);
  if (!draft) return draft.error();
  std::ofstream(draft->path(), std::ios::binary) << text;
  return draft->publish();
}

/// Both ways to write an output.
using Writer = std::function<Result<void>(const fs::path&, const std::string&)>;
const std::vector<std::pair<const char*, Writer>>& writers() {
  static const std::vector<std::pair<const char*, Writer>> both{
      {"bytes",
       [](const fs::path& name, const std::string& text) { return write_text(name, text); }},
      {"draft", by_draft}};
  return both;
}

/// One line: a reason and, behind a semicolon, what to do.
void expect_refused(const Result<void>& done, const std::string& part, const std::string& what) {
  ASSERT_FALSE(done) << what;
  const std::string& message = done.error().message;
  EXPECT_NE(message.find(part), std::string::npos) << what << ": " << message;
  EXPECT_NE(message.find("; "), std::string::npos) << what << ": " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << what << ": " << message;
}

TEST(Output, ReplacesAFileWholeAndLeavesNoOther) {
  for (const auto& [how, write] : writers()) {
    const Folder folder;
    ASSERT_TRUE(write(folder / "a", "old and long")) << how;
    ASSERT_TRUE(write(folder / "a", "new")) << how;
    EXPECT_EQ(text_of(folder / "a"), "new") << how;
    EXPECT_EQ(entries(folder.path()), 1u) << how;
  }
}

TEST(Output, KeepsThePermissionsOfWhatItReplaces) {
  for (const auto& [how, write] : writers()) {
    const Folder folder;
    ASSERT_TRUE(write(folder / "a", "old"));
    ASSERT_EQ(::chmod((folder / "a").c_str(), 0600), 0);
    ASSERT_TRUE(write(folder / "a", "new"));
    EXPECT_EQ(mode_of(folder / "a") & 0777u, 0600u) << how;
  }
}

TEST(Output, AnotherNameOfTheSameFileKeepsTheOldText) {
  for (const auto& [how, write] : writers()) {
    const Folder folder;
    ASSERT_TRUE(write(folder / "a", "old"));
    fs::create_hard_link(folder / "a", folder / "b");
    ASSERT_TRUE(write(folder / "a", "new"));
    EXPECT_EQ(text_of(folder / "a"), "new") << how;
    EXPECT_EQ(text_of(folder / "b"), "old") << how;
  }
}

TEST(Output, FollowsSymbolicLinksToTheirTarget) {
  for (const auto& [how, write] : writers()) {
    const Folder folder;
    fs::create_directory(folder / "far");
    ASSERT_TRUE(write(folder / "far/target", "old"));
    fs::create_symlink("far/target", folder / "one");
    fs::create_symlink(folder / "one", folder / "two");
    fs::create_symlink("far", folder / "near");
    ASSERT_TRUE(write(folder / "two", "chain")) << how;
    EXPECT_EQ(text_of(folder / "far/target"), "chain") << how;
    ASSERT_TRUE(write(folder / "near/target", "folder")) << how;
    EXPECT_EQ(text_of(folder / "far/target"), "folder") << how;
    for (const char* link : {"one", "two", "near"}) EXPECT_TRUE(fs::is_symlink(folder / link));
    EXPECT_EQ(entries(folder.path()), 4u) << how;
    EXPECT_EQ(entries(folder / "far"), 1u) << how;
  }
}

TEST(Output, MakesTheTargetOfADanglingLink) {
  for (const auto& [how, write] : writers()) {
    const Folder folder;
    fs::create_symlink("target", folder / "link");
    ASSERT_TRUE(write(folder / "link", "made")) << how;
    EXPECT_TRUE(fs::is_symlink(folder / "link")) << how;
    EXPECT_EQ(text_of(folder / "target"), "made") << how;
    fs::create_symlink("missing/target", folder / "lost");
    expect_refused(write(folder / "lost", "x"), "No such file", how);
  }
}

TEST(Output, RefusesLoopsFoldersAndLinksIntoFolders) {
  for (const auto& [how, write] : writers()) {
    const Folder folder;
    fs::create_directory(folder / "in");
    std::ofstream(folder / "in/kept") << "kept";
    fs::create_symlink("in", folder / "link");
    fs::create_symlink("loop", folder / "loop");
    expect_refused(write(folder / "in", "x"), "directory", how);
    expect_refused(write(folder / "in/", "x"), "directory", how);
    expect_refused(write(folder / "new/", "x"), "directory", how);
    expect_refused(write(folder / "link", "x"), "directory", how);
    expect_refused(write(folder / "loop", "x"), "symbolic links", how);
    expect_refused(write("", "x"), "No such file", how);
    expect_refused(write(folder / "in/kept/below", "x"), "Not a directory", how);
    expect_refused(write(folder / std::string(300, 'x'), "x"), "too long", how);
    EXPECT_EQ(text_of(folder / "in/kept"), "kept") << how;
    EXPECT_EQ(entries(folder.path()), 3u) << how;
    EXPECT_EQ(entries(folder / "in"), 1u) << how;
  }
}

TEST(Output, TakesTheLongestNameThatThereIs) {
  for (const auto& [how, write] : writers()) {
    const Folder folder;
    ASSERT_TRUE(write(folder / std::string(255, 'x'), "long")) << how;
    EXPECT_EQ(entries(folder.path()), 1u) << how;
  }
}

TEST(Output, WritesIntoAPipeThatIsRead) {
  for (const auto& [how, write] : writers()) {
    const Folder folder;
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    fs::create_symlink("pipe", folder / "link");
    const std::string text(1 << 20, 'x');  // more than a pipe holds
    std::string seen;
    std::thread reader([&] {
      const int descriptor = ::open((folder / "pipe").c_str(), O_RDONLY | O_CLOEXEC);
      seen = read_all(descriptor);
      ::close(descriptor);
    });
    const Result<void> done = write(folder / "link", text);
    reader.join();
    EXPECT_TRUE(done) << how << done.error().message;
    EXPECT_EQ(seen, text) << how;
    EXPECT_TRUE(S_ISFIFO(mode_of(folder / "pipe"))) << how;
    EXPECT_EQ(entries(folder.path()), 2u) << how;
  }
}

TEST(Output, GivesUpAPipeThatNobodyReads) {
  const Folder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_TRUE(check_writable(folder / "pipe"));
  expect_refused(write_text(folder / "pipe", "x"), "nobody reads the pipe", "no reader");
  EXPECT_TRUE(S_ISFIFO(mode_of(folder / "pipe")));
}

TEST(Output, AReaderThatLeavesIsAnErrorAndNoSignal) {
  for (const auto& [how, write] : writers()) {
    const Folder folder;
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    std::thread reader([&] {
      const int descriptor = ::open((folder / "pipe").c_str(), O_RDONLY | O_CLOEXEC);
      char byte = 0;
      EXPECT_EQ(::read(descriptor, &byte, 1), 1);
      ::close(descriptor);
    });
    const Result<void> done = write(folder / "pipe", std::string(1 << 20, 'x'));
    reader.join();
    expect_refused(done, "Broken pipe", how);
  }
}

TEST(Output, WritesIntoASocketThatListensAndRefusesOthers) {
  for (const auto& [how, write] : writers()) {
    // Deeper than an address can say.
    const Folder folder;
    const fs::path deep = folder / std::string(120, 'd');
    fs::create_directory(deep);
    const fs::path before = fs::current_path();
    fs::current_path(deep);
    const int listening = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int deaf = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const auto bound = [](int descriptor, const char* name) {
      sockaddr_un address{};
      address.sun_family = AF_UNIX;
      std::strncpy(address.sun_path, name, sizeof address.sun_path - 1);
      return ::bind(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
    };
    ASSERT_TRUE(bound(listening, "socket") && ::listen(listening, 1) == 0 && bound(deaf, "deaf"));
    fs::current_path(before);
    std::string seen;
    std::thread reader([&] {
      const int descriptor = ::accept(listening, nullptr, nullptr);
      seen = read_all(descriptor);
      ::close(descriptor);
    });
    const Result<void> done = write(deep / "socket", "by socket");
    reader.join();
    EXPECT_TRUE(done) << how << done.error().message;
    EXPECT_EQ(seen, "by socket") << how;
    expect_refused(write(deep / "deaf", "x"), "refused", how);
    EXPECT_TRUE(S_ISSOCK(mode_of(deep / "socket")) && S_ISSOCK(mode_of(deep / "deaf"))) << how;
    ::close(listening);
    ::close(deaf);
  }
}

TEST(Output, WritesIntoItsOwnStandardOutputWhateverItIs) {
  for (const bool socket : {false, true}) {
    int ends[2];
    ASSERT_EQ(socket ? ::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) : ::pipe(ends), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      ::dup2(ends[1], STDOUT_FILENO);
      ::close(ends[0]);
      ::close(ends[1]);
      ::_exit(write_text("/dev/stdout", "standard") ? 0 : 1);
    }
    ::close(ends[1]);
    EXPECT_EQ(read_all(ends[0]), "standard") << socket;
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0) << socket;
  }
}

TEST(Output, AFileThatWasDeletedWhileOpenGetsNoNewName) {
  const Folder folder;
  const int descriptor = ::open((folder / "gone").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  fs::remove(folder / "gone");
  expect_refused(write_text("/proc/self/fd/" + std::to_string(descriptor), "x"), "deleted", "fd");
  ::close(descriptor);
  EXPECT_EQ(entries(folder.path()), 0u);
}

/// Own nodes: the system's are nobody's to try things on.
bool make_node(const fs::path& path, mode_t type, unsigned major_number, unsigned minor_number) {
  return ::mknod(path.c_str(), type | 0600, makedev(major_number, minor_number)) == 0;
}

TEST(Output, WritesIntoACharacterDeviceAndLeavesItOne) {
  const Folder folder;
  if (!make_node(folder / "full", S_IFCHR, 1, 7) || !make_node(folder / "null", S_IFCHR, 1, 3))
    GTEST_SKIP() << "device nodes are made by root alone";
  const int probe = ::open((folder / "null").c_str(), O_WRONLY | O_CLOEXEC);
  if (probe < 0) GTEST_SKIP() << "device nodes do not work in this folder";
  ::close(probe);
  fs::create_symlink("full", folder / "link");
  for (const auto& [how, write] : writers()) {
    EXPECT_TRUE(write(folder / "null", "swallowed")) << how;
    expect_refused(write(folder / "full", "x"), "No space left", how);
    expect_refused(write(folder / "link", "x"), "No space left", how);
    EXPECT_TRUE(S_ISCHR(mode_of(folder / "null")) && S_ISCHR(mode_of(folder / "full"))) << how;
    EXPECT_EQ(entries(folder.path()), 3u) << how;
  }
}

TEST(Output, RefusesABlockDevice) {
  const Folder folder;
  if (!make_node(folder / "disk", S_IFBLK, 7, 200))
    GTEST_SKIP() << "device nodes are made by root alone";
  for (const auto& [how, write] : writers()) {
    expect_refused(write(folder / "disk", "x"), "block device", how);
    EXPECT_TRUE(S_ISBLK(mode_of(folder / "disk"))) << how;
  }
}

TEST(Output, ADeviceThatTakesTheNameMeanwhileIsNotReplaced) {
  const Folder folder;
  Result<Draft> draft = Draft::create(folder / "a");
  ASSERT_TRUE(draft);
  std::ofstream(draft->path()) << "new";
  ASSERT_EQ(::mkfifo((folder / "a").c_str(), 0600), 0);
  EXPECT_FALSE(draft->publish());
  EXPECT_TRUE(S_ISFIFO(mode_of(folder / "a")));
  EXPECT_EQ(text_of(draft->path()), "new");
}

TEST(Output, PublishingNewReplacesNothing) {
  const Folder folder;
  Result<Draft> draft = Draft::create(folder / "a");
  ASSERT_TRUE(draft);
  std::ofstream(draft->path()) << "new";
  std::ofstream(folder / "a") << "came meanwhile";
  expect_refused(draft->publish_new(), "exists", "new");
  EXPECT_EQ(text_of(folder / "a"), "came meanwhile");
}

/// Runs something as a user without rights. @return whether it could be run and returned true.
bool as_nobody(const std::function<bool()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    if (::geteuid() == 0 && (::setgid(kNobody) != 0 || ::setuid(kNobody) != 0)) ::_exit(2);
    ::_exit(work() ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(Output, LeavesReadOnlyFilesAndFoldersAlone) {
  for (const auto& [how, write] : writers()) {
    const Folder folder;
    fs::create_directory(folder / "open");
    fs::create_directory(folder / "shut");
    std::ofstream(folder / "open/a") << "mine";
    std::ofstream(folder / "shut/a") << "mine";
    ::chmod(folder.path().c_str(), 0755);
    ::chmod((folder / "open").c_str(), 0777);
    ::chmod((folder / "open/a").c_str(), 0444);
    ::chmod((folder / "shut/a").c_str(), 0666);
    ::chmod((folder / "shut").c_str(), 0555);
    EXPECT_TRUE(as_nobody([&, &write = write] {
      return !write(folder / "open/a", "x") && !write(folder / "shut/a", "x") &&
             !write(folder / "shut/b", "x") && !check_writable(folder / "open/a") &&
             !check_writable(folder / "shut/b") && write(folder / "open/b", "x");
    })) << how;
    EXPECT_EQ(text_of(folder / "open/a"), "mine") << how;
    EXPECT_EQ(text_of(folder / "shut/a"), "mine") << how;
    ::chmod((folder / "shut").c_str(), 0755);
  }
}

TEST(Output, AFullDiskKeepsTheOldFile) {
  const Folder folder;
  const fs::path disk = folder / "disk";
  fs::create_directory(disk);
  if (::mount("none", disk.c_str(), "tmpfs", 0, "size=64k") != 0)
    GTEST_SKIP() << "file systems are mounted by root alone";
  for (const auto& [how, write] : writers()) {
    EXPECT_TRUE(write(disk / "a", "old")) << how;
    EXPECT_FALSE(write_text(disk / "a", std::string(1 << 20, 'x'))) << how;
    EXPECT_EQ(text_of(disk / "a"), "old") << how;
    EXPECT_EQ(entries(disk), 1u) << how;
  }
  expect_refused(write_text(disk / "a", std::string(1 << 20, 'x')), "No space left", "full");
  EXPECT_EQ(::umount(disk.c_str()), 0);
}

TEST(Output, OfSeveralEitherAllAppearOrNone) {
  const Folder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  ASSERT_TRUE(write_text(folder / "a", "old"));
  {
    Outputs outputs;
    EXPECT_TRUE(outputs.add(folder / "a", "new"));
    expect_refused(outputs.add(folder / "none/b", "new"), "No such file", "missing folder");
  }
  {
    Outputs outputs;
    EXPECT_TRUE(outputs.add(folder / "a", "new"));
    EXPECT_TRUE(outputs.add(folder / "pipe", "new"));
    expect_refused(outputs.publish(), "nobody reads the pipe", "no reader");
  }
  EXPECT_EQ(text_of(folder / "a"), "old");
  EXPECT_EQ(entries(folder.path()), 2u);
  Outputs outputs;
  EXPECT_TRUE(outputs.add(folder / "a", "new"));
  EXPECT_TRUE(outputs.add(folder / "b", "new"));
  EXPECT_EQ(text_of(folder / "a"), "old");
  EXPECT_TRUE(outputs.publish());
  EXPECT_EQ(text_of(folder / "a") + text_of(folder / "b"), "newnew");
  EXPECT_EQ(entries(folder.path()), 3u);
}

TEST(Output, WhatIsKeptAsOldReplacesAFileAlone) {
  const Folder folder;
  fs::create_symlink("a", folder / "link");
  ASSERT_TRUE(write_text(folder / "a", "1"));
  ASSERT_TRUE(keep_as_old(folder / "link"));
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(text_of(folder / "a.old"), "1");
  ASSERT_TRUE(write_text(folder / "link", "2"));
  ASSERT_TRUE(keep_as_old(folder / "a"));
  EXPECT_EQ(text_of(folder / "a.old"), "2");
  ASSERT_TRUE(write_text(folder / "b", "3"));
  ASSERT_EQ(::mkfifo((folder / "b.old").c_str(), 0600), 0);
  expect_refused(keep_as_old(folder / "b"), "b.old", "pipe");
  EXPECT_EQ(text_of(folder / "b"), "3");
  EXPECT_TRUE(keep_as_old(folder / "missing"));
  EXPECT_TRUE(keep_as_old(folder.path()));
}

TEST(Output, CheckingAPathTouchesNothing) {
  const Folder folder;
  EXPECT_TRUE(check_writable(folder / "a"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
  ASSERT_TRUE(write_text(folder / "a", "kept"));
  EXPECT_TRUE(check_writable(folder / "a"));
  EXPECT_EQ(text_of(folder / "a"), "kept");
  EXPECT_FALSE(check_writable(folder.path()));
  EXPECT_FALSE(check_writable(folder / "none/a"));
  EXPECT_FALSE(check_writable(""));
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(Output, KilledInTheMiddleItIsTheOldFileOrTheNewAndTheNextRunTidiesUp) {
  const Folder folder;
  const std::string old(300'000, 'o'), fresh(300'000, 'n');
  ASSERT_TRUE(write_text(folder / "a", old));
  std::mt19937 random(1);
  std::size_t left_behind = 0;
  for (int round = 0; round < 60; ++round) {
    const pid_t child = ::fork();
    if (child == 0) {
      while (true)
        if (!write_text(folder / "a", fresh) || !by_draft(folder / "a", old)) ::_exit(1);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(2000 + random() % 8000));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    const std::string text = text_of(folder / "a");
    ASSERT_TRUE(text == old || text == fresh) << round << ": " << text.size() << " bytes";
    left_behind += entries(folder.path()) - 1;
    ASSERT_TRUE(write_text(folder / "a", old));  // at once, not a minute later
    ASSERT_EQ(entries(folder.path()), 1u) << round;
  }
  EXPECT_GT(left_behind, 0u);  // some were killed in the middle
}

}  // namespace
}  // namespace skerry
