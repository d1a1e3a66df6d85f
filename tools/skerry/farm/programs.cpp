#include "tools/skerry/farm/programs.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "engine/core/log.h"
#include "game/scene_file/parse.h"

namespace skerry::tools {
namespace {

std::vector<char*> arguments_of(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

Error cannot_run(const std::string& program, int reason) {
  return {fmt::format("cannot run {}: {}", game::quote_text(program), std::strerror(reason))};
}

/// A file without a name, which takes what a program writes: unlike a pipe it never fills up.
class Captured {
 public:
  Captured() : descriptor_(::memfd_create("output", MFD_CLOEXEC)) {}
  ~Captured() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;

  int descriptor() const { return descriptor_; }
  std::string text() const {
    std::string all;
    std::array<char, 4096> block;
    ::lseek(descriptor_, 0, SEEK_SET);
    for (ssize_t got = 0; (got = ::read(descriptor_, block.data(), block.size())) > 0;)
      all.append(block.data(), static_cast<std::size_t>(got));
    return all;
  }

 private:
  int descriptor_;
};

}  // namespace

Result<ProgramEnd> run_program(std::vector<std::string> words) {
  const Captured out, err;
  if (out.descriptor() < 0 || err.descriptor() < 0) return cannot_run(words.front(), errno);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, out.descriptor(), STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, err.descriptor(), STDERR_FILENO);
  pid_t process = 0;
  const std::vector<char*> arguments = arguments_of(words);
  const int failed =
      ::posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return cannot_run(words.front(), failed);
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return ProgramEnd{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), out.text(),
                    err.text()};
}

Result<std::filesystem::path> own_program() {
  std::error_code code;
  std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", code);
  if (!code) return program;
  return Error{fmt::format("cannot find this program's file: {}; mount /proc", code.message())};
}

Error become_program(std::vector<std::string> words) {
  std::fflush(nullptr);
  const std::vector<char*> arguments = arguments_of(words);
  ::execv(arguments[0], arguments.data());
  return cannot_run(words.front(), errno);
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of("\r\n");
  if (end == std::string::npos) return {};
  const std::size_t before = text.find_last_of('\n', end);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  return one_line(text.substr(first, end - first + 1));
}

}  // namespace skerry::tools
