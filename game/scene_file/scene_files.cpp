#include "game/scene_file/scene_files.h"

#include <cstdlib>
#include <filesystem>

namespace skerry::game {

std::string file_of_scene(const std::string& scene_file, const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path beside = fs::path(scene_file).parent_path() / path;
  const char* const folder = std::getenv(kFilesVariable);
  std::error_code code;
  if (!folder || fs::exists(beside, code) || !fs::exists(fs::path(folder) / path, code))
    return beside.string();
  return (fs::path(folder) / path).string();
}

}  // namespace skerry::game
