#include "world/confined/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <thread>
#include <utility>

#include "engine/core/clock.h"

namespace skerry::world {
namespace {

using std::chrono::microseconds;

// Standard streams of a process that was started without them must not be mistaken for ours.
constexpr int kLowestDescriptor = 10;
// A file of a few kilobytes is read in less than the first; a long wait should not cost wake-ups.
constexpr microseconds kFirstNap{500}, kLongestNap{20'000};

Result<Descriptor> lifted(int fd) {
  Descriptor high(::fcntl(fd, F_DUPFD_CLOEXEC, kLowestDescriptor));
  if (high.get() < 0) return Error{fmt::format("no file descriptor is left ({})", strerror(errno))};
  return high;
}

Result<pid_t> start(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                    int input, int output) {
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  char* no_environment[] = {nullptr};

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  // What the C library says of a corrupted heap is no message for a user.
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed =
      ::posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), no_environment);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) {
    return Error{fmt::format("its reader {} does not start ({}); build the target {}",
                             program.string(), strerror(failed), program.filename().string())};
  }
  return child;
}

/// The status of waitpid, or none if the time ran out; then the child has been killed.
std::optional<int> wait_for(pid_t child, int input, std::uint64_t input_bytes, double wall_s,
                            const ReadProgress& progress) {
  const Stopwatch watch;
  int status = 0;
  for (microseconds nap = kFirstNap; ::waitpid(child, &status, WNOHANG) == 0;
       nap = std::min(nap * 2, kLongestNap)) {
    if (watch.seconds() > wall_s) {
      ::kill(child, SIGKILL);
      ::waitpid(child, &status, 0);
      return std::nullopt;
    }
    // The child shares the descriptor's offset.
    const off_t read = ::lseek(input, 0, SEEK_CUR);
    if (progress && input_bytes > 0 && read >= 0)
      progress(std::min(1.0, static_cast<double>(read) / static_cast<double>(input_bytes)));
    std::this_thread::sleep_for(nap);
  }
  return status;
}

/// What a child's end means. @param status none: it was killed after limits.wall_s.
Result<void> outcome_of(const ConfinedProgram& program, std::optional<int> status, bool writes,
                        const ReadLimits& limits) {
  const char* const job = writes ? "writing" : "reading";
  const char* const advice = writes ? "export less" : "the file is damaged or too large";
  if (!status) return Error{fmt::format("{} took more than {} s; {}", job, limits.wall_s, advice)};
  if (WIFSIGNALED(*status) && WTERMSIG(*status) == SIGXCPU)
    return Error{
        fmt::format("{} took more than {} s of processor time; {}", job, limits.cpu_s, advice)};
  if (WIFSIGNALED(*status) && WTERMSIG(*status) == SIGKILL)
    return Error{fmt::format("the system ended {}, most likely for want of memory; {}", job,
                             writes ? advice : "close other programs or make the file smaller")};
  if (WIFSIGNALED(*status) && WTERMSIG(*status) == SIGSYS)
    return Error{
        fmt::format("it made {} try to reach out of its process, which was ended; do not trust it",
                    program.library)};
  if (WIFSIGNALED(*status) && writes)
    return Error{
        fmt::format("{} crashed (signal {}); {}", program.library, WTERMSIG(*status), advice)};
  if (WIFSIGNALED(*status))
    return Error{fmt::format("the file is damaged: {} crashed on it (signal {})", program.library,
                             WTERMSIG(*status))};
  if (WEXITSTATUS(*status) == 0) return {};
  constexpr int kCannotStart = 127;  // of the dynamic loader, too
  if (WEXITSTATUS(*status) == kCannotStart)
    return Error{fmt::format("{} cannot start, as when a library of {} is missing; install it",
                             program.name, program.library)};
  if (writes)
    return Error{
        fmt::format("{} gave up without a word; check the space on the disk", program.library)};
  return Error{
      fmt::format("the file is damaged: {} gave up on it without a word", program.library)};
}

}  // namespace

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}
Descriptor::Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  Descriptor taken(std::move(other));
  std::swap(fd_, taken.fd_);
  return *this;
}

Result<MemoryFile> MemoryFile::create() {
  Descriptor file(::memfd_create("skerry_answer", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (file.get() < 0)
    return Error{fmt::format("there is no memory to read it into ({})", strerror(errno))};
  return MemoryFile(std::move(file));
}

MemoryFile::MemoryFile(MemoryFile&& other) noexcept
    : file_(std::move(other.file_)),
      mapped_(std::exchange(other.mapped_, nullptr)),
      size_(std::exchange(other.size_, 0)) {}

MemoryFile::~MemoryFile() {
  if (mapped_) ::munmap(mapped_, size_);
}

bool MemoryFile::append(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

Result<std::span<const std::byte>> MemoryFile::seal() {
  struct stat state {};
  if (::fcntl(file_.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE) != 0 ||
      ::fstat(file_.get(), &state) != 0)
    return Error{"its reader left an answer that can still change; the file is likely damaged"};
  size_ = static_cast<std::size_t>(state.st_size);
  if (size_ == 0) return std::span<const std::byte>();
  void* mapped = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file_.get(), 0);
  if (mapped == MAP_FAILED)
    return Error{fmt::format("there is no memory for it ({})", strerror(errno))};
  mapped_ = mapped;
  return std::span(static_cast<const std::byte*>(mapped_), size_);
}

std::filesystem::path path_of(const ConfinedProgram& program) {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / program.name;
}

Result<void> run_confined(const ConfinedProgram& program, const std::vector<std::string>& arguments,
                          int input, int output, std::uint64_t input_bytes,
                          const ReadLimits& limits, const ReadProgress& progress) {
  const Result<Descriptor> in = lifted(input), out = lifted(output);
  if (!in) return in.error();
  if (!out) return out.error();
  std::vector<std::string> words = {std::to_string(limits.memory_bytes),
                                    std::to_string(limits.answer_bytes),
                                    std::to_string(limits.cpu_s)};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const Result<pid_t> child = start(path_of(program), words, in->get(), out->get());
  if (!child) return child.error();
  const std::optional<int> status =
      wait_for(*child, in->get(), input_bytes, limits.wall_s, progress);
  return outcome_of(program, status, arguments.front() == "write", limits);
}

Result<MemoryFile> read_confined(const ConfinedProgram& program, const std::filesystem::path& path,
                                 const std::function<ReadLimits(std::uint64_t bytes)>& limits_for,
                                 const ReadProgress& progress) {
  // Not blocking, so that a pipe nobody writes to is refused rather than waited for.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat state {};
  if (file.get() < 0 || ::fstat(file.get(), &state) != 0)
    return Error{fmt::format("{}; check the path", strerror(errno))};
  if (!S_ISREG(state.st_mode)) return Error{"it is no regular file; check the path"};
  Result<MemoryFile> answer = MemoryFile::create();
  if (!answer) return answer;
  const auto size = static_cast<std::uint64_t>(state.st_size);
  const Result<void> ran = run_confined(program, {"read"}, file.get(), answer->descriptor(), size,
                                        limits_for(size), progress);
  if (!ran) return ran.error();
  return answer;
}

}  // namespace skerry::world
