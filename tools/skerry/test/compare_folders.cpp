#include "tools/skerry/test/compare_folders.h"

#include <fmt/format.h>

#include <set>

#include "engine/core/clock.h"
#include "engine/core/jobs.h"
#include "game/scene_file/parse.h"
#include "tools/skerry/compare/report_pictures.h"

namespace skerry::tools {
namespace {

namespace fs = std::filesystem;

/// Adds the names of a folder's pictures, without their ending.
Result<void> add_names(const fs::path& folder, std::set<std::string>& names) {
  const auto wrong = [&](const std::string& why) {
    return Error{fmt::format("cannot compare the pictures of {}: {}; give two folders of PNG files",
                             game::quote_text(folder.string()), why)};
  };
  std::error_code code;
  if (!fs::is_directory(folder, code)) return wrong("it is no folder");
  for (auto file = fs::directory_iterator(folder, code); !code && file != fs::directory_iterator();
       file.increment(code))
    if (file->path().extension() == ".png") names.insert(file->path().stem().string());
  if (code) return wrong(code.message());
  return {};
}

/// One side's picture. None: its folder has no file of that name.
std::optional<Result<platform::PngImage>> picture_of(const fs::path& folder,
                                                     const std::string& name) {
  const fs::path file = folder / (name + ".png");
  std::error_code code;
  if (!fs::exists(file, code)) return std::nullopt;
  return platform::read_png(file);
}

/// Why a row fails before anything is compared; empty if both pictures are there.
std::string missing(const std::optional<Result<platform::PngImage>>& reference,
                    const std::optional<Result<platform::PngImage>>& actual,
                    const game::Expectations& expected) {
  if (!reference) return "there is no reference of this name";
  if (!actual) return "there is a reference alone";
  if (!*reference) return reference->error().message;
  if (!*actual) return actual->error().message;
  if (same_size(**reference, **actual)) {
    const auto checked =
        game::check_expectations(expected, {(*reference)->width, (*reference)->height});
    return checked ? std::string() : checked.error().message;
  }
  return fmt::format("the reference has {}x{} pixels, the picture {}x{}", (*reference)->width,
                     (*reference)->height, (*actual)->width, (*actual)->height);
}

Row compared_row(const CompareOptions& options, const std::string& name) {
  const Stopwatch watch;
  Row row;
  row.scene = name;
  const auto reference = picture_of(options.reference, name);
  const auto actual = picture_of(options.actual, name);
  ShownPair shown;
  if (reference && *reference) shown.reference = &**reference;
  if (actual && *actual) shown.actual = &**actual;
  row.pictures = shown.actual ? 1 : 0;
  row.message = missing(reference, actual, options.expected);
  Comparison compared;
  if (row.message.empty()) {
    compared = compare(*shown.reference, *shown.actual, options.expected);
    shown.compared = &compared;
    row.take(compared);
    row.message = beyond(compared.difference, compared.parts, options.expected);
  }
  if (row.message.empty()) row.verdict = Verdict::kPass;
  if (const auto written = write_report_pictures(options.html, name, shown); !written) {
    row.verdict = Verdict::kFail;
    row.message = written.error().message;
  }
  row.failed_runs = row.failed() ? 1 : 0;
  row.seconds = watch.seconds();
  return row;
}

}  // namespace

Result<std::vector<Row>> compare_folders(const CompareOptions& options) {
  std::set<std::string> found;
  for (const fs::path& folder : {options.reference, options.actual})
    if (const auto added = add_names(folder, found); !added) return added.error();
  if (found.empty()) return Error{"there is nothing to compare: neither folder has a *.png"};
  const std::vector<std::string> names(found.begin(), found.end());
  std::vector<Row> rows(names.size());
  Jobs jobs;
  jobs.parallel_for(static_cast<int>(names.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    rows[at] = compared_row(options, names[at]);
  });
  return rows;
}

}  // namespace skerry::tools
