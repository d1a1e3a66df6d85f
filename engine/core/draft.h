#pragma once
#include <filesystem>
#include <memory>
#include <system_error>

#include "engine/core/interruption.h"
#include "engine/core/result.h"

namespace skerry {

/// A hidden folder beside a name in which what will have that name is made, so that nothing
/// unfinished ever has it. It goes with its owner, and when the process is interrupted. What a
/// killed process left there is removed by the next one that makes a draft for that name; others
/// may be at work on the same name meanwhile.
class Draft {
 public:
  /// Errors: the system's reason why the folder cannot be made.
  static Result<Draft> create(const std::filesystem::path& final_path);
  ~Draft();
  Draft(Draft&&) noexcept;
  Draft& operator=(Draft&&) = delete;

  const std::filesystem::path& folder() const { return folder_; }
  /// Where a file or folder of the final name is made.
  std::filesystem::path path() const { return folder_ / final_path_.filename(); }

  /// Gives what is at path() its name; what has it is replaced. Nothing is left of the draft.
  /// Errors: the system's reason.
  Result<void> publish();

 private:
  /// Holds the folder's lock, which says that somebody is at work in it.
  struct Hold;
  Draft(std::filesystem::path final_path, std::filesystem::path folder, std::unique_ptr<Hold> hold);
  std::error_code replace_folder() const;

  std::filesystem::path final_path_, folder_;
  std::unique_ptr<Hold> hold_;
};

}  // namespace skerry
