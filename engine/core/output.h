#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/output_place.h"
#include "engine/core/result.h"

namespace skerry {

/// Writes all of `bytes` to the place of an output. A file appears when it is whole (Draft); its
/// other names (hard links) keep what they had, its permissions stay. A pipe that nobody reads is
/// given up after ten seconds. Errors name the path, the reason and what to do; nothing is left
/// behind.
Result<void> write_file(const std::filesystem::path& name, std::span<const std::byte> bytes);
Result<void> write_text(const std::filesystem::path& name, std::string_view text);

/// Renames a regular file, or what a link at that name leads to, to NAME.old, for write_file to
/// make a new one; an older NAME.old is replaced. Errors: NAME.old is no regular file; the folder
/// may not be written. Nothing happens when the name leads to anything else.
Result<void> keep_as_old(const std::filesystem::path& name);

/// Several outputs of one command: all of them, or none.
class Outputs {
 public:
  Outputs();
  ~Outputs();
  Outputs(const Outputs&) = delete;
  Outputs& operator=(const Outputs&) = delete;

  /// Makes everything ready short of the name. Errors: as write_file.
  Result<void> add(const std::filesystem::path& name, std::span<const std::byte> bytes);
  Result<void> add(const std::filesystem::path& name, std::string_view text);
  /// Streams come first: what they refuse is known before a file is replaced. Errors: as
  /// write_file.
  Result<void> publish();

 private:
  struct Ready;
  std::vector<Ready> ready_;
};

/// Whether write_file would get as far as writing. Leaves nothing behind, touches no file and opens
/// no stream.
Result<void> check_writable(const std::filesystem::path& name);

}  // namespace skerry
