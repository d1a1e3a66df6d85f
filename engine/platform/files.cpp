#include "engine/platform/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "engine/core/interruption.h"

namespace skerry::platform {
namespace {

namespace fs = std::filesystem;

std::string reason(int code) {
  return std::strerror(code);
}

Error write_error(const fs::path& path, int code) {
  return Error{fmt::format("cannot write '{}': {}; give a path in a folder you may write to",
                           path.string(), reason(code))};
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
  /// Closes now. @return errno, or 0: a full disk may only be noticed here.
  int close_now() { return ::close(std::exchange(descriptor_, -1)) == 0 ? 0 : errno; }

 private:
  int descriptor_;
};

/// The process id keeps two programs that write the same path from sharing a temporary file.
fs::path temporary_of(const fs::path& path) {
  fs::path temporary = path;
  temporary += fmt::format(".{}.tmp", ::getpid());
  return temporary;
}

/// @return errno, or 0.
int write_all(File& file, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return file.close_now();
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

Result<void> write_file(const fs::path& path, std::span<const std::byte> bytes) {
  struct stat info {};
  const bool exists = ::stat(path.c_str(), &info) == 0;
  if (exists && S_ISDIR(info.st_mode)) return write_error(path, EISDIR);
  if (exists && !S_ISREG(info.st_mode)) {
    // A device or a pipe is written to; a rename would put a file in its place.
    File special(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    if (special.get() < 0) return write_error(path, errno);
    const int code = write_all(special, bytes);
    return code == 0 ? Result<void>{} : write_error(path, code);
  }
  std::error_code unresolved;
  const fs::path target =
      fs::is_symlink(path, unresolved) ? fs::weakly_canonical(path, unresolved) : path;
  const fs::path temporary = temporary_of(target);
  const RemovedWhenInterrupted guard(temporary);
  File file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (file.get() < 0) return write_error(path, errno);
  int code = write_all(file, bytes);
  if (code == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) code = errno;
  if (code == 0) return {};
  ::unlink(temporary.c_str());
  return write_error(path, code);
}

Result<void> write_text(const fs::path& path, std::string_view text) {
  return write_file(path, std::as_bytes(std::span(text)));
}

Result<void> check_writable(const fs::path& path) {
  if (path.empty()) return write_error(path, ENOENT);
  struct stat info {};
  const bool exists = ::stat(path.c_str(), &info) == 0;
  if (exists && S_ISDIR(info.st_mode)) return write_error(path, EISDIR);
  if (exists && !S_ISREG(info.st_mode))
    return ::access(path.c_str(), W_OK) == 0 ? Result<void>{} : write_error(path, errno);
  const fs::path temporary = temporary_of(path);
  const File file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (file.get() < 0) return write_error(path, errno);
  ::unlink(temporary.c_str());
  return {};
}

Result<std::string> read_text(const fs::path& path, std::uint64_t max_bytes) {
  const auto failed = [&](const std::string& why) {
    return Error{fmt::format("cannot read '{}': {}; give a readable file", path.string(), why)};
  };
  const File file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) return failed(reason(errno));
  std::string text;
  char block[1 << 16];
  while (true) {
    const ssize_t got = ::read(file.get(), block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return failed(reason(errno));
    if (got == 0) return text;
    // Counted while reading: the size a pipe or a growing file states says nothing.
    if (text.size() + static_cast<std::size_t>(got) > max_bytes) {
      return failed(fmt::format("it is larger than {} bytes", max_bytes));
    }
    text.append(block, static_cast<std::size_t>(got));
  }
}

fs::path executable_dir() {
  std::error_code code;
  const fs::path self = fs::read_symlink("/proc/self/exe", code);
  return code ? fs::path(".") : self.parent_path();
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
  return Error{fmt::format("cannot create the folder '{}': {}; check who owns the folder above it",
                           dir.string(), code.message())};
}

}  // namespace skerry::platform
