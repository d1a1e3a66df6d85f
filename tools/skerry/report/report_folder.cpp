#include "tools/skerry/report/report_folder.h"

#include <fmt/format.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "game/parse.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

Error cannot_write(const fs::path& dir, std::string_view why) {
  return {fmt::format("cannot write the report {}: {}; choose another folder with --out",
                      game::quote_text(dir.string()), why)};
}

/// Whether a finished report may take this place.
Result<void> check_place(const fs::path& dir) {
  std::error_code code;
  const fs::file_status status = fs::symlink_status(dir, code);
  if (status.type() == fs::file_type::not_found) return {};
  if (status.type() != fs::file_type::directory)
    return cannot_write(dir, code ? code.message() : "it exists and is no folder");
  const bool empty = fs::is_empty(dir, code);
  if (code) return cannot_write(dir, code.message());
  if (!empty && !fs::is_regular_file(dir / kReportFile, code))
    return cannot_write(dir, "it holds files that are no report");
  return {};
}

}  // namespace

ReportFolder::ReportFolder(fs::path dir, fs::path filling)
    : dir_(std::move(dir)), filling_(std::move(filling)) {}

ReportFolder::ReportFolder(ReportFolder&& other) noexcept
    : dir_(std::move(other.dir_)), filling_(std::move(other.filling_)) {
  other.filling_.clear();
}

ReportFolder::~ReportFolder() {
  std::error_code ignored;
  if (!filling_.empty()) fs::remove_all(filling_, ignored);
}

Result<ReportFolder> ReportFolder::create(const fs::path& dir) {
  std::error_code code;
  fs::path place = fs::absolute(dir, code).lexically_normal();
  if (code) return cannot_write(dir, code.message());
  if (!place.has_filename()) place = place.parent_path();  // a name that ends in /
  if (!place.has_filename()) return cannot_write(dir, "it is no name of a folder");
  if (Result<void> free = check_place(place); !free) return free.error();
  std::string filling =
      (place.parent_path() / fmt::format(".{}.XXXXXX", place.filename().string())).string();
  if (::mkdtemp(filling.data()) == nullptr) return cannot_write(dir, std::strerror(errno));
  ::chmod(filling.c_str(), 0755);  // mkdtemp's 0700 would hide the report from other users
  return ReportFolder(std::move(place), std::move(filling));
}

Result<void> ReportFolder::publish() {
  if (Result<void> free = check_place(dir_); !free) return free.error();
  std::error_code code;
  const fs::path old = filling_.string() + ".old";
  const bool replaces = fs::exists(dir_, code);
  if (replaces) fs::rename(dir_, old, code);
  if (code) return cannot_write(dir_, code.message());
  fs::rename(filling_, dir_, code);
  if (code) {
    const Error error = cannot_write(dir_, code.message());
    if (replaces) fs::rename(old, dir_, code);
    return error;
  }
  filling_.clear();
  if (replaces) fs::remove_all(old, code);
  return {};
}

}  // namespace skerry::tools
