#include "tools/skerry/report/file_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "game/scene_file/parse.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

/// Whether a name still leads to an open file: its last owner removes it.
bool is_named(int descriptor, const fs::path& file) {
  struct stat held {
  }, named{};
  return ::fstat(descriptor, &held) == 0 && ::lstat(file.c_str(), &named) == 0 &&
         held.st_dev == named.st_dev && held.st_ino == named.st_ino;
}

Error lock_error(const fs::path& file, int code) {
  return {
      fmt::format("cannot lock {}: {}; give a folder that you may write, on a file system with "
                  "locks",
                  game::quote_text(file.string()), std::strerror(code))};
}

}  // namespace

FileLock::FileLock(fs::path file, int descriptor)
    : file_(std::move(file)), descriptor_(descriptor) {}

FileLock::FileLock(FileLock&& other) noexcept
    : file_(std::move(other.file_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

FileLock::~FileLock() {
  if (descriptor_ < 0) return;
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

Result<FileLock> FileLock::take(const fs::path& file) {
  Result<std::optional<FileLock>> lock = take(file, LOCK_EX);
  if (!lock) return lock.error();
  return **std::move(lock);
}

Result<std::optional<FileLock>> FileLock::try_take(const fs::path& file) {
  return take(file, LOCK_EX | LOCK_NB);
}

Result<std::optional<FileLock>> FileLock::take(const fs::path& file, int operation) {
  while (true) {
    const int descriptor =
        ::open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (descriptor < 0) return lock_error(file, errno);
    int code = 0;
    while ((code = ::flock(descriptor, operation) == 0 ? 0 : errno) == EINTR) {
    }
    if (code == 0 && is_named(descriptor, file))
      return std::optional<FileLock>(FileLock(file, descriptor));
    ::close(descriptor);
    if (code == EWOULDBLOCK) return std::optional<FileLock>();
    if (code != 0) return lock_error(file, code);
  }
}

}  // namespace skerry::tools
