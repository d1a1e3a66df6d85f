#pragma once
#include <filesystem>
#include <memory>

#include "engine/core/interruption.h"
#include "engine/core/output_place.h"
#include "engine/core/result.h"

namespace skerry {

/// A hidden folder beside an output in which what will have its name is made, so that nothing
/// unfinished ever has it. It goes with its owner, and when the process is interrupted. What a
/// killed process left there is removed by the next one that makes a draft for that name; others
/// may be at work on the same name meanwhile. The rule of find_output() holds: a link's target is
/// what is replaced, and a draft for a stream lies in the folder for temporary files.
class Draft {
 public:
  enum class What { kFile, kFolder };

  /// Errors: `reason; advice`: there is something else than a file (or folder) or something that
  /// may not be written; the hidden folder cannot be made.
  static Result<Draft> create(const std::filesystem::path& name, What what = What::kFile);
  ~Draft();
  Draft(Draft&&) noexcept;
  Draft& operator=(Draft&&) = delete;

  const std::filesystem::path& folder() const { return folder_; }
  /// Where a file or folder of the final name is made.
  std::filesystem::path path() const { return folder_ / place_.path.filename(); }

  /// Whether it will be written into something instead of getting a name.
  bool is_stream() const { return place_.kind == OutputPlace::Kind::kStream; }

  /// Gives what is at path() its name; a file (or folder) that has it is replaced and keeps its
  /// permissions. Into a stream, it is written. Nothing is left of the draft.
  /// Errors: `reason; advice`; the name then has what it had.
  Result<void> publish();
  /// As publish(), but replaces nothing.
  Result<void> publish_new();

 private:
  /// Holds the folder's lock, which says that somebody is at work in it.
  struct Hold;
  Draft(OutputPlace place, std::filesystem::path folder, std::unique_ptr<Hold> hold);
  Result<void> publish(bool replaces);

  OutputPlace place_;
  std::filesystem::path folder_;
  std::unique_ptr<Hold> hold_;
};

}  // namespace skerry
