// Files that a scene file names.
#pragma once
#include <string>

namespace skerry::game {

/// The folder for files that do not lie beside the scene files that name them.
inline constexpr const char* kFilesVariable = "SKERRY_FILES";

/// Where such a file is: relative paths are meant from the scene file's folder; if there is none,
/// from the folder in the environment variable SKERRY_FILES, if it has one.
std::string file_of_scene(const std::string& scene_file, const std::string& path);

}  // namespace skerry::game
