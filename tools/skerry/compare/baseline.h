#pragma once
#include <filesystem>
#include <optional>

#include "engine/core/draft.h"
#include "engine/core/result.h"
#include "tools/skerry/compare/unpacked.h"

namespace skerry::tools {

/// References outside the repository (docs/testing.md): a folder, or a tar archive of one, which
/// is unpacked as long as this lives.
class Baseline {
 public:
  /// @param path an archive if it ends in ".tar", else a folder. @param make it may be missing.
  /// Errors: there is none; of unpacking.
  static Result<Baseline> open(const std::filesystem::path& path, bool make);

  /// The folder, with a folder for each driver.
  std::filesystem::path folder() const { return unpacked_ ? unpacked_->path() : path_; }
  /// None: it is a folder.
  std::optional<Unpacked> unpacked() const;
  /// Puts what was approved into the archive. In a folder it is already. Errors: of writing.
  Result<void> save() const;

 private:
  Baseline(std::filesystem::path path, std::optional<Draft> unpacked)
      : path_(std::move(path)), unpacked_(std::move(unpacked)) {}

  std::filesystem::path path_;
  std::optional<Draft> unpacked_;  // of an archive; never gets a name
};

}  // namespace skerry::tools
