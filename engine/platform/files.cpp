#include "engine/platform/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>

#include "engine/core/output.h"

namespace skerry::platform {
namespace {

namespace fs = std::filesystem;

std::string reason(int code) {
  return std::strerror(code);
}

/// A file descriptor that closes itself.
class File {
 public:
  explicit File(int descriptor) : descriptor_(descriptor) {}
  ~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

constexpr std::chrono::seconds kMostWait{10};

/// Until there is something to read, or the end. A pipe that nobody has opened to write has
/// neither. @return errno, or 0.
int wait_to_read(int descriptor, std::chrono::steady_clock::time_point end) {
  while (true) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    pollfd wanted{descriptor, POLLIN, 0};
    const int ready = ::poll(&wanted, 1, static_cast<int>(std::max<std::int64_t>(0, left.count())));
    if (ready > 0) return 0;
    if (ready == 0) return ETIMEDOUT;
    if (errno != EINTR) return errno;
  }
}

fs::path xdg_dir(const char* variable, const char* below_home) {
  // The specification says to ignore relative paths.
  if (const char* set = std::getenv(variable); set && set[0] == '/')
    return fs::path(set) / "skerry";
  if (const char* home = std::getenv("HOME"); home && home[0] == '/') {
    return fs::path(home) / below_home / "skerry";
  }
  return {};
}

}  // namespace

Result<std::string> read_text(const fs::path& path, std::uint64_t max_bytes) {
  const auto failed = [&](const std::string& why) {
    return Error{fmt::format("cannot read {}: {}; give a readable file", quoted_path(path), why)};
  };
  // Not blocking, so that a pipe can be waited for no longer than that.
  const File file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (file.get() < 0) return failed(reason(errno));
  const auto end = std::chrono::steady_clock::now() + kMostWait;
  std::string text;
  char block[1 << 16];
  while (true) {
    if (const int code = wait_to_read(file.get(), end); code == ETIMEDOUT)
      return failed(fmt::format("all of it did not come within {} s", kMostWait.count()));
    else if (code != 0)
      return failed(reason(code));
    const ssize_t got = ::read(file.get(), block, sizeof block);
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (got < 0) return failed(reason(errno));
    if (got == 0) return text;
    // Counted while reading: the size a pipe or a growing file states says nothing.
    if (text.size() + static_cast<std::size_t>(got) > max_bytes) {
      return failed(fmt::format("it is larger than {} bytes", max_bytes));
    }
    text.append(block, static_cast<std::size_t>(got));
  }
}

fs::path cache_dir() {
  return xdg_dir("XDG_CACHE_HOME", ".cache");
}
fs::path config_dir() {
  return xdg_dir("XDG_CONFIG_HOME", ".config");
}
fs::path data_dir() {
  return xdg_dir("XDG_DATA_HOME", ".local/share");
}

Result<void> make_dirs(const fs::path& dir) {
  std::error_code code;
  fs::create_directories(dir, code);
  if (!code) return {};
  return Error{fmt::format("cannot create the folder {}: {}; check who owns the folder above it",
                           quoted_path(dir), code.message())};
}

}  // namespace skerry::platform
