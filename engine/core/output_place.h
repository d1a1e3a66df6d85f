#pragma once
#include <filesystem>
#include <string>

#include "engine/core/result.h"

namespace skerry {

/// What the name of an output leads to. The rule for every output of every command: symbolic links
/// are followed to their target; only a regular file is replaced, and by a finished one; character
/// devices, pipes and sockets are written into; anything else is refused.
struct OutputPlace {
  enum class Kind {
    kFree,    ///< nothing has that name
    kFile,    ///< a regular file
    kFolder,  ///< for outputs that are folders
    kStream,  ///< a character device, pipe or socket
  };
  Kind kind = Kind::kFree;
  /// Absolute and, except for a stream, no symbolic link itself.
  std::filesystem::path path;
};

/// Errors say why and what to do, not the name: a loop of links, a block device, a folder that may
/// not be searched.
Result<OutputPlace> find_output(const std::filesystem::path& name);

/// What errno says of an output, and what to do about it: `reason; advice`.
Error output_error(int code);

/// A path for a message: in quotation marks, on one line whatever is in it.
std::string quoted_path(const std::filesystem::path& path);

}  // namespace skerry
