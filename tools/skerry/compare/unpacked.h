// Names of files that may be members of an archive.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace skerry::tools {

/// What an archive was unpacked into. The paths of files there are temporary.
struct Unpacked {
  std::filesystem::path archive, folder;
};
/// A file, quoted, as a user knows it: by its path, or as a member of the archive it is from.
std::string known_as(const std::filesystem::path& file, const std::optional<Unpacked>& from);

}  // namespace skerry::tools
