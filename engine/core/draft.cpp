#include "engine/core/draft.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

namespace skerry {
namespace {

namespace fs = std::filesystem;

// Between making a folder and locking it; no process is stopped there for longer.
constexpr std::chrono::minutes kLeastAge{1};

std::string prefix_of(const fs::path& final_path) {
  return fmt::format(".{}.draft.", final_path.filename().string());
}

/// A descriptor of a folder that nobody else is at work in, or -1.
int locked(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor < 0 || ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  ::close(descriptor);
  return -1;
}

bool is_old(const fs::path& folder) {
  std::error_code code;
  const fs::file_time_type changed = fs::last_write_time(folder, code);
  return !code && fs::file_time_type::clock::now() - changed > kLeastAge;
}

/// What killed processes left behind of drafts for this name.
void remove_abandoned(const fs::path& final_path) {
  const std::string prefix = prefix_of(final_path);
  std::error_code code, ignored;
  const fs::path parent = final_path.parent_path();
  for (fs::directory_iterator at(parent, code), end; !code && at != end; at.increment(code)) {
    const fs::path folder = at->path();
    if (!folder.filename().string().starts_with(prefix) || !is_old(folder)) continue;
    const int descriptor = locked(folder);
    if (descriptor < 0) continue;
    fs::remove_all(folder, ignored);
    ::close(descriptor);
  }
}

}  // namespace

struct Draft::Hold {
  Hold(const fs::path& folder, int lock) : removed(folder), descriptor(lock) {}
  ~Hold() { ::close(descriptor); }

  RemovedWhenInterrupted removed;
  int descriptor;
};

Draft::Draft(fs::path final_path, fs::path folder, std::unique_ptr<Hold> hold)
    : final_path_(std::move(final_path)), folder_(std::move(folder)), hold_(std::move(hold)) {}

Draft::Draft(Draft&&) noexcept = default;

Draft::~Draft() {
  std::error_code ignored;
  if (hold_) fs::remove_all(folder_, ignored);
}

Result<Draft> Draft::create(const fs::path& final_path) {
  std::error_code code;
  const fs::path absolute = fs::absolute(final_path, code);
  if (code) return Error{code.message()};
  remove_abandoned(absolute);
  std::string name = (absolute.parent_path() / (prefix_of(absolute) + "XXXXXX")).string();
  if (::mkdtemp(name.data()) == nullptr) return Error{std::strerror(errno)};
  const int descriptor = locked(name);
  if (descriptor < 0) {
    const Error error{std::strerror(errno)};
    ::rmdir(name.c_str());
    return error;
  }
  return Draft(absolute, name, std::make_unique<Hold>(name, descriptor));
}

Result<void> Draft::publish() {
  // Changed places, where there is something already: the old one then goes with the draft.
  std::error_code code;
  uninterrupted([&] {
    if (::renameat2(AT_FDCWD, path().c_str(), AT_FDCWD, final_path_.c_str(), RENAME_EXCHANGE) != 0)
      fs::rename(path(), final_path_, code);
    if (code == std::errc::directory_not_empty) code = replace_folder();
  });
  if (code) return Error{code.message()};
  fs::remove_all(folder_, code);
  hold_.reset();
  return {};
}

/// For file systems that cannot exchange two names at once.
std::error_code Draft::replace_folder() const {
  std::error_code code, ignored;
  const fs::path old = folder_ / ".old";
  fs::rename(final_path_, old, code);
  if (code) return code;
  fs::rename(path(), final_path_, code);
  if (code) fs::rename(old, final_path_, ignored);
  return code;
}

}  // namespace skerry
