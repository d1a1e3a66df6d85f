// Files of other people that tests look at if they are there; the repository does not hold them.
#pragma once
#include <test_paths.h>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace skerry {

/// A file of the folder SKERRY_FILES, else of shared/vdb beside the sources.
inline std::filesystem::path real_file(const std::string& name) {
  const char* const folder = std::getenv("SKERRY_FILES");
  return std::filesystem::path(folder ? folder : SKERRY_SOURCE_DIR "/../shared/vdb") / name;
}

}  // namespace skerry
