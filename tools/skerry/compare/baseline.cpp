#include "tools/skerry/compare/baseline.h"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>

#include "engine/core/output.h"
#include "engine/platform/files.h"
#include "engine/platform/tar.h"

namespace skerry::tools {

namespace fs = std::filesystem;

Result<Baseline> Baseline::open(const fs::path& path, bool make) {
  std::error_code code;
  const bool archive = path.extension() == ".tar";
  const bool there = archive ? fs::is_regular_file(path, code) : fs::is_directory(path, code);
  if (!there && !(make && !fs::exists(path, code)))
    return Error{fmt::format("there is no {} {}: --baseline needs one that --approve made",
                             archive ? "archive" : "folder", quoted_path(path))};
  if (!archive) return Baseline(path, std::nullopt);
  const fs::path temporary = fs::temp_directory_path(code);
  if (code) return Error{fmt::format("cannot unpack {}: {}", quoted_path(path), code.message())};
  // Of this process alone: others may unpack theirs at the same time.
  Result<Draft> draft = Draft::create(temporary / fmt::format("skerry_baseline_{}", ::getpid()),
                                      Draft::What::kFolder);
  if (!draft)
    return Error{fmt::format("cannot unpack {}: {}", quoted_path(path), draft.error().message)};
  if (Result<void> made = platform::make_dirs(draft->path()); !made) return made.error();
  if (there)
    if (Result<void> done = platform::unpack_tar(path, draft->path()); !done) return done.error();
  return Baseline(path, *std::move(draft));
}

std::optional<Unpacked> Baseline::unpacked() const {
  if (!unpacked_) return std::nullopt;
  return Unpacked{path_, unpacked_->path()};
}

Result<void> Baseline::save() const {
  return unpacked_ ? platform::pack_tar(unpacked_->path(), path_) : Result<void>();
}

}  // namespace skerry::tools
