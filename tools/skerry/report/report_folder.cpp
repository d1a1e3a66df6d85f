#include "tools/skerry/report/report_folder.h"

#include <fmt/format.h>
#include <string>
#include <system_error>

#include "game/scene_file/parse.h"

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

ReportFolder::ReportFolder(fs::path dir, Draft draft)
    : dir_(std::move(dir)), draft_(std::move(draft)) {}

Result<ReportFolder> ReportFolder::create(const fs::path& dir) {
  std::error_code code;
  fs::path place = fs::absolute(dir, code).lexically_normal();
  if (code) return cannot_write(dir, code.message());
  if (!place.has_filename()) place = place.parent_path();  // a name that ends in /
  if (!place.has_filename()) return cannot_write(dir, "it is no name of a folder");
  if (Result<void> free = check_place(place); !free) return free.error();
  Result<Draft> draft = Draft::create(place);
  if (!draft) return cannot_write(dir, draft.error().message);
  fs::create_directory(draft->path(), code);
  if (code) return cannot_write(dir, code.message());
  return ReportFolder(std::move(place), *std::move(draft));
}

Result<void> ReportFolder::publish() {
  if (Result<void> free = check_place(dir_); !free) return free.error();
  if (const Result<void> done = draft_.publish(); !done)
    return cannot_write(dir_, done.error().message);
  return {};
}

}  // namespace skerry::tools
