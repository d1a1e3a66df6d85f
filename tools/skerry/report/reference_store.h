// References of a report in a folder, so that each is computed once, whichever tasks need it.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "engine/core/result.h"
#include "game/scene_file/options.h"
#include "tools/measure/picture.h"

namespace skerry::tools {

/// What a report takes from a picture of the CPU reference.
struct KeptReference {
  measure::Picture radiance;  ///< before exposure
  double ev = 0.0;            ///< stops to be developed at
  std::optional<double> mean_error;
  double seconds = 0.0;  ///< that it took to compute
};

/// Hash of what a reference depends on: the scene and the contents of the files that it names, the
/// settings that the reference renderer reads, and this program.
/// Errors: a file cannot be read.
Result<std::string> reference_id(const game::SceneOptions& scene);

class ReferenceStore {
 public:
  using Make = std::function<Result<KeptReference>()>;

  /// @param folder made with the first entry. Any number of processes and machines may share it.
  explicit ReferenceStore(std::filesystem::path folder);

  /// The entry of an id. A missing or damaged one is made: by one process at a time, the others
  /// wait for it; if it ends early, by whatever, the next one takes over. An entry that cannot be
  /// written is a warning. Errors: those of `make`.
  Result<KeptReference> get(const std::string& id, const Make& make) const;

  /// Whether there is an entry, whole or not.
  bool has(const std::string& id) const;

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path entry(const std::string& id) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace skerry::tools
