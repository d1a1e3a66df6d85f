#pragma once
#include <filesystem>

#include "engine/core/result.h"

namespace skerry::platform {

/// Files of a tar archive into an empty folder. Names that are long in the ways of pax and GNU are
/// understood; links and devices are refused, as are names that lead out of the folder.
/// Source: POSIX.1-2017, pax, sections "pax Interchange Format" and "ustar Interchange Format".
/// Errors: unreadable, cut short, damaged, a file of more than 256 MiB; of writing.
Result<void> unpack_tar(const std::filesystem::path& archive, const std::filesystem::path& into);

/// Packs a folder's regular files, in the order of their names: the same names and bytes give the
/// same archive. It replaces a file of its name when it is whole. Errors: a name is longer than
/// ustar has room for (100 bytes, and 155 of folders); of reading and writing.
Result<void> pack_tar(const std::filesystem::path& folder, const std::filesystem::path& archive);

}  // namespace skerry::platform
