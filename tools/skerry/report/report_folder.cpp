#include "tools/skerry/report/report_folder.h"

#include <fmt/format.h>
#include <system_error>

#include "engine/core/output.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

/// @param why a reason, and what to do.
Error cannot_write(const fs::path& dir, std::string_view option, std::string_view why) {
  return {fmt::format("cannot write the report {} {}: {}", option, quoted_path(dir), why)};
}

/// Whether a finished report may take this place.
Result<void> check_place(const fs::path& dir, std::string_view option) {
  const auto refuse = [&](std::string_view why) {
    return cannot_write(dir, option, fmt::format("{}; choose another folder", why));
  };
  const Result<OutputPlace> place = find_output(dir);
  if (!place) return cannot_write(dir, option, place.error().message);
  if (place->kind == OutputPlace::Kind::kFree) return {};
  if (place->kind != OutputPlace::Kind::kFolder) return refuse("it exists and is no folder");
  std::error_code code;
  const bool empty = fs::is_empty(place->path, code);
  if (code) return refuse(code.message());
  if (!empty && !fs::is_regular_file(place->path / kReportFile, code))
    return refuse("it holds files that are no report");
  return {};
}

}  // namespace

ReportFolder::ReportFolder(fs::path dir, std::string option, Draft draft)
    : dir_(std::move(dir)), option_(std::move(option)), draft_(std::move(draft)) {}

Result<ReportFolder> ReportFolder::create(const fs::path& dir, std::string_view option) {
  std::error_code code;
  fs::path place = fs::absolute(dir, code).lexically_normal();
  if (code) return cannot_write(dir, option, output_error(code.value()).message);
  if (!place.has_filename()) place = place.parent_path();  // a name that ends in /
  if (!place.has_filename())
    return cannot_write(dir, option, "it is no name of a folder; choose one");
  if (Result<void> free = check_place(place, option); !free) return free.error();
  Result<Draft> draft = Draft::create(place, Draft::What::kFolder);
  if (!draft) return cannot_write(dir, option, draft.error().message);
  fs::create_directory(draft->path(), code);
  if (code) return cannot_write(dir, option, output_error(code.value()).message);
  return ReportFolder(std::move(place), std::string(option), *std::move(draft));
}

Result<void> ReportFolder::publish() {
  if (Result<void> free = check_place(dir_, option_); !free) return free.error();
  if (const Result<void> done = draft_.publish(); !done)
    return cannot_write(dir_, option_, done.error().message);
  return {};
}

}  // namespace skerry::tools
