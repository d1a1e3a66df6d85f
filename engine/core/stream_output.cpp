#include "engine/core/stream_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "engine/core/output_place.h"

namespace skerry {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kWaitForReader{10};

/// While this lives, a write to a pipe without a reader fails with EPIPE in this thread and sends
/// no signal that would end the program.
class WithoutSigpipe {
 public:
  WithoutSigpipe() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    ::pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~WithoutSigpipe() {
    const timespec at_once{};
    while (!sigismember(&before_, SIGPIPE) && ::sigtimedwait(&pipe_, nullptr, &at_once) > 0) {
    }
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  WithoutSigpipe(const WithoutSigpipe&) = delete;
  WithoutSigpipe& operator=(const WithoutSigpipe&) = delete;

 private:
  sigset_t pipe_, before_;
};

/// A socket that the program was started with, as /dev/stdout may be: it cannot be connected to.
int duplicate_of_own(const struct stat& wanted) {
  for (const int own : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat info {};
    if (::fstat(own, &info) == 0 && info.st_dev == wanted.st_dev && info.st_ino == wanted.st_ino)
      return ::fcntl(own, F_DUPFD_CLOEXEC, 3);
  }
  return -1;
}

/// @return a descriptor, or -1 and errno.
int connected(const std::filesystem::path& path) {
  // By way of a descriptor: an address holds 107 bytes, a path more.
  const int place = ::open(path.c_str(), O_PATH | O_CLOEXEC);
  if (place < 0) return -1;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  fmt::format_to_n(address.sun_path, sizeof address.sun_path - 1, "/proc/self/fd/{}", place);
  const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const bool done = descriptor >= 0 && ::connect(descriptor, reinterpret_cast<sockaddr*>(&address),
                                                 sizeof address) == 0;
  const int code = errno;
  ::close(place);
  if (done) return descriptor;
  if (descriptor >= 0) ::close(descriptor);
  errno = code;
  return -1;
}

/// @return a descriptor that blocks, or -1 and errno: ENXIO when nobody reads a pipe.
int opened(const std::filesystem::path& path) {
  const Clock::time_point end = Clock::now() + kWaitForReader;
  while (true) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (descriptor >= 0) {
      ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
      return descriptor;
    }
    if (errno == EINTR) continue;
    if (errno != ENXIO || Clock::now() > end) return -1;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

}  // namespace

int write_all(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return 0;
}

Result<StreamOutput> StreamOutput::open(const std::filesystem::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return output_error(errno);
  int descriptor = -1;
  if (S_ISSOCK(info.st_mode)) {
    descriptor = duplicate_of_own(info);
    if (descriptor < 0) descriptor = connected(path);
  } else {
    descriptor = opened(path);
    if (descriptor < 0 && errno == ENXIO && S_ISFIFO(info.st_mode))
      return Error{"nobody reads the pipe; start the program that reads it first"};
  }
  if (descriptor < 0) return output_error(errno);
  return StreamOutput(descriptor);
}

StreamOutput::~StreamOutput() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

StreamOutput::StreamOutput(StreamOutput&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

Result<void> StreamOutput::write(std::span<const std::byte> bytes) {
  const WithoutSigpipe quiet;
  const int code = write_all(descriptor_, bytes);
  return code == 0 ? Result<void>{} : output_error(code);
}

Result<void> StreamOutput::close() {
  return ::close(std::exchange(descriptor_, -1)) == 0 ? Result<void>{} : output_error(errno);
}

Result<void> copy_into_stream(const std::filesystem::path& file,
                              const std::filesystem::path& stream) {
  const int from = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (from < 0) return output_error(errno);
  Result<StreamOutput> to = StreamOutput::open(stream);
  Result<void> done = to ? Result<void>{} : to.error();
  std::vector<std::byte> block(1 << 16);
  for (ssize_t got = 1; done && got != 0;) {
    got = ::read(from, block.data(), block.size());
    if (got > 0) done = to->write(std::span(block).first(static_cast<std::size_t>(got)));
    if (got < 0 && errno != EINTR) done = output_error(errno);
  }
  ::close(from);
  return done ? to->close() : done;
}

}  // namespace skerry
