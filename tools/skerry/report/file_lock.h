#pragma once
#include <filesystem>
#include <optional>

#include "engine/core/result.h"

namespace skerry::tools {

/// A lock between processes, as a file that is there while somebody has it or waits for it. The
/// kernel holds it (flock), and so it ends with its process, however that ends; a file that a
/// killed process left is taken over by the next one.
class FileLock {
 public:
  /// Waits until nobody else has it. Errors: the file cannot be made; the file system has no locks.
  static Result<FileLock> take(const std::filesystem::path& file);
  /// The same, but none if somebody has it.
  static Result<std::optional<FileLock>> try_take(const std::filesystem::path& file);
  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;

 private:
  FileLock(std::filesystem::path file, int descriptor);
  static Result<std::optional<FileLock>> take(const std::filesystem::path& file, int operation);

  std::filesystem::path file_;
  int descriptor_;  // -1: moved from
};

}  // namespace skerry::tools
