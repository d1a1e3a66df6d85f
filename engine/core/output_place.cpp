#include "engine/core/output_place.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>

#include "engine/core/log.h"

namespace skerry {
namespace {

namespace fs = std::filesystem;

/// As many as the kernel follows.
constexpr int kMaxLinks = 40;

std::string_view advice(int code) {
  switch (code) {
    case ENOSPC:
    case EDQUOT:
      return "free some space or give a path on another disk";
    case EISDIR:
      return "give the name of a file";
    case ENOTDIR:
      return "give a path whose folders exist";
    case ELOOP:
      return "give a path whose symbolic links lead somewhere";
    case ENAMETOOLONG:
      return "give a shorter path";
    case EPIPE:
    case ECONNREFUSED:
    case ECONNRESET:
      return "keep the program that reads it running";
    case EEXIST:
      return "give another path";
    case EROFS:
    case EACCES:
    case EPERM:
    case ENOENT:
      return "give a path in a folder you may write to";
    default:
      return "give another path";
  }
}

/// Follows the last part of a path as long as it is a symbolic link. @return errno, or 0 and the
/// end in `path`, which need not exist.
int follow_links(fs::path& path) {
  for (int count = 0; count <= kMaxLinks; ++count) {
    struct stat info {};
    if (::lstat(path.c_str(), &info) != 0) return errno == ENOENT ? 0 : errno;
    if (!S_ISLNK(info.st_mode)) return 0;
    std::error_code code;
    const fs::path target = fs::read_symlink(path, code);
    if (code) return code.value();
    path = path.parent_path() / target;  // an absolute target replaces all of it
  }
  return ELOOP;
}

}  // namespace

Error output_error(int code) {
  return {fmt::format("{}; {}", std::strerror(code), advice(code))};
}

std::string quoted_path(const fs::path& path) {
  return fmt::format("'{}'", one_line(path.native()));
}

Result<OutputPlace> find_output(const fs::path& name) {
  if (name.empty()) return output_error(ENOENT);
  std::error_code failed;
  OutputPlace place{OutputPlace::Kind::kFree, fs::absolute(name, failed)};
  if (failed) return output_error(failed.value());
  struct stat info {};
  const bool exists = ::stat(place.path.c_str(), &info) == 0;
  if (!exists && errno != ENOENT) return output_error(errno);
  if (exists && (S_ISCHR(info.st_mode) || S_ISFIFO(info.st_mode) || S_ISSOCK(info.st_mode))) {
    place.kind = OutputPlace::Kind::kStream;
    return place;
  }
  if (exists && S_ISBLK(info.st_mode)) return Error{"it is a block device; give another path"};
  if (const int code = follow_links(place.path)) return output_error(code);
  if (!place.path.has_filename() && !(exists && S_ISDIR(info.st_mode))) return output_error(EISDIR);
  if (!exists) return place;
  // A link below /proc leads to an open file, whether or not that still has the name the link
  // holds.
  struct stat found {};
  if (::lstat(place.path.c_str(), &found) != 0)
    return Error{"the file that it leads to has been deleted; give another path"};
  place.kind = S_ISDIR(info.st_mode) ? OutputPlace::Kind::kFolder : OutputPlace::Kind::kFile;
  return place;
}

}  // namespace skerry
