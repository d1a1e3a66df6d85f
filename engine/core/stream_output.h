#pragma once
#include <cstddef>
#include <filesystem>
#include <span>

#include "engine/core/result.h"

namespace skerry {

/// Writes all of it. @return errno, or 0.
int write_all(int descriptor, std::span<const std::byte> bytes);

/// An open character device, pipe or socket to write into. Neither a reader that leaves (SIGPIPE)
/// nor one that never comes stops the program.
class StreamOutput {
 public:
  /// Waits up to ten seconds for somebody to read a pipe. Errors: `reason; advice`.
  static Result<StreamOutput> open(const std::filesystem::path& path);
  ~StreamOutput();
  StreamOutput(StreamOutput&& other) noexcept;
  StreamOutput& operator=(StreamOutput&&) = delete;

  /// Errors: `reason; advice`: a full device, a reader that has left.
  Result<void> write(std::span<const std::byte> bytes);
  /// To be called last: some devices say only now that they are full.
  Result<void> close();

 private:
  explicit StreamOutput(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

/// Writes a finished file into a stream. Errors: `reason; advice`.
Result<void> copy_into_stream(const std::filesystem::path& file,
                              const std::filesystem::path& stream);

}  // namespace skerry
