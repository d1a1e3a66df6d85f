#include "engine/core/draft.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "engine/core/stream_output.h"

namespace skerry {
namespace {

namespace fs = std::filesystem;
using Kind = OutputPlace::Kind;

/// Of drafts for a name. A name may be as long as the file system allows; what is cut off makes
/// drafts of two names look alike, which costs nothing: only abandoned ones are removed.
std::string prefix_of(const fs::path& name) {
  constexpr std::size_t kMaxShown = 200;
  return fmt::format(".{}.draft.", name.filename().string().substr(0, kMaxShown));
}

bool is_open_folder(int descriptor, const fs::path& folder) {
  struct stat held {
  }, named{};
  return ::fstat(descriptor, &held) == 0 && ::lstat(folder.c_str(), &named) == 0 &&
         held.st_dev == named.st_dev && held.st_ino == named.st_ino;
}

/// A descriptor of a folder that is there and that nobody else is at work in, or -1 and errno;
/// EWOULDBLOCK: somebody is, or removes it.
int locked(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor < 0) {
    if (errno == ENOENT) errno = EWOULDBLOCK;
    return -1;
  }
  int code = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
  if (code == 0 && is_open_folder(descriptor, folder)) return descriptor;
  if (code == 0) code = EWOULDBLOCK;
  ::close(descriptor);
  errno = code;
  return -1;
}

/// What killed processes left behind in a folder.
void remove_abandoned(const fs::path& parent, const std::string& prefix) {
  std::error_code code, ignored;
  for (fs::directory_iterator at(parent, code), end; !code && at != end; at.increment(code)) {
    const fs::path folder = at->path();
    if (!folder.filename().string().starts_with(prefix)) continue;
    const int descriptor = locked(folder);
    if (descriptor < 0) continue;
    fs::remove_all(folder, ignored);
    ::close(descriptor);
  }
}

/// Why there can be no draft of this kind for a place. @return errno, or 0.
int refusal(const OutputPlace& place, Draft::What what) {
  if (place.kind == Kind::kFree) return 0;
  if (what == Draft::What::kFolder) return place.kind == Kind::kFolder ? 0 : ENOTDIR;
  if (place.kind == Kind::kFolder) return EISDIR;
  return ::faccessat(AT_FDCWD, place.path.c_str(), W_OK, AT_EACCESS) == 0 ? 0 : errno;
}

bool same_type(const fs::path& a, const fs::path& b) {
  struct stat of_a {
  }, of_b{};
  return ::lstat(a.c_str(), &of_a) == 0 && ::lstat(b.c_str(), &of_b) == 0 &&
         (of_a.st_mode & S_IFMT) == (of_b.st_mode & S_IFMT);
}

/// For file systems that can do nothing but rename. @return errno, or 0.
int rename_plainly(const fs::path& from, const fs::path& to, bool replaces) {
  std::error_code code, ignored;
  const bool exists = fs::symlink_status(to, code).type() != fs::file_type::not_found;
  if (exists && (!replaces || !same_type(from, to))) return EEXIST;
  if (!exists || !fs::is_directory(from, code)) {
    fs::rename(from, to, code);
    return code.value();
  }
  const fs::path old = from.parent_path() / ".old";
  fs::rename(to, old, code);
  if (code) return code.value();
  fs::rename(from, to, code);
  if (code) fs::rename(old, to, ignored);
  return code.value();
}

/// Gives a file or folder its name. What has it goes to `from`, and is of the same type, or
/// nothing happens, even if it came there a moment ago. @return errno, or 0.
int give_name(const fs::path& from, const fs::path& to, bool replaces) {
  const auto rename = [](const fs::path& a, const fs::path& b, unsigned how) {
    return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), how) == 0 ? 0 : errno;
  };
  int code = 0;
  for (int attempt = 0; attempt < 10; ++attempt) {
    code = rename(from, to, RENAME_NOREPLACE);
    if (code == EINVAL || code == ENOSYS) return rename_plainly(from, to, replaces);
    if (code != EEXIST || !replaces) return code;
    code = rename(from, to, RENAME_EXCHANGE);
    if (code == EINVAL) return rename_plainly(from, to, replaces);
    if (code == ENOENT) continue;  // what had the name has gone since
    if (code != 0 || same_type(from, to)) return code;
    code = rename(from, to, RENAME_EXCHANGE);
    return code == 0 ? EEXIST : code;
  }
  return code;
}

}  // namespace

struct Draft::Hold {
  Hold(const fs::path& folder, int lock) : removed(folder), descriptor(lock) {}
  ~Hold() { ::close(descriptor); }

  RemovedWhenInterrupted removed;
  int descriptor;
};

Draft::Draft(OutputPlace place, fs::path folder, std::unique_ptr<Hold> hold)
    : place_(std::move(place)), folder_(std::move(folder)), hold_(std::move(hold)) {}

Draft::Draft(Draft&&) noexcept = default;

Draft::~Draft() {
  std::error_code ignored;
  if (hold_) fs::remove_all(folder_, ignored);
}

Result<Draft> Draft::create(const fs::path& name, What what) {
  const Result<OutputPlace> place = find_output(name);
  if (!place) return place.error();
  if (const int code = refusal(*place, what)) return output_error(code);
  std::error_code failed;
  const fs::path parent =
      place->kind == Kind::kStream ? fs::temp_directory_path(failed) : place->path.parent_path();
  if (failed) return output_error(failed.value());
  const std::string prefix = prefix_of(place->path);
  remove_abandoned(parent, prefix);
  // Another process may take a folder that is not locked yet for an abandoned one.
  for (int attempt = 0; attempt < 100; ++attempt) {
    std::string folder = (parent / (prefix + "XXXXXX")).string();
    if (::mkdtemp(folder.data()) == nullptr) return output_error(errno);
    const int descriptor = locked(folder);
    if (descriptor >= 0) return Draft(*place, folder, std::make_unique<Hold>(folder, descriptor));
    const int code = errno;
    ::rmdir(folder.c_str());
    if (code != EWOULDBLOCK) return output_error(code);
  }
  return output_error(EAGAIN);
}

Result<void> Draft::publish() {
  return publish(true);
}

Result<void> Draft::publish_new() {
  return publish(false);
}

Result<void> Draft::publish(bool replaces) {
  if (place_.kind == Kind::kStream) {
    if (!replaces) return output_error(EEXIST);
    const Result<void> copied = copy_into_stream(path(), place_.path);
    if (!copied) return copied;
  } else {
    struct stat info {};
    constexpr mode_t kPermissions = S_IRWXU | S_IRWXG | S_IRWXO;
    if (place_.kind == Kind::kFile && ::lstat(place_.path.c_str(), &info) == 0)
      ::chmod(path().c_str(), info.st_mode & kPermissions);
    int code = 0;
    uninterrupted([&] { code = give_name(path(), place_.path, replaces); });
    if (code != 0) return output_error(code);
  }
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
  hold_.reset();
  return {};
}

}  // namespace skerry
