#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "game/scene_file/options.h"

namespace skerry::game {

/// What the settings screen keeps between runs: quality, field of view and the settings that it
/// shows. Written as a scene file of those fields.
struct ReadPreferences {
  SceneText scene;                    ///< valid; what was not understood is left out
  std::vector<std::string> problems;  ///< of what was not, each a line for the player
};
ReadPreferences read_preferences(std::string_view json_text);
/// Makes the settings that are kept those of another; the others stay.
void take_preferences(const Settings& from, Settings& into);
std::string print_preferences(const SceneOptions& scene);

/// `settings.json` in the user's folder for configuration; empty if there is none.
std::filesystem::path preferences_path();
/// A file that is not there is no problem.
ReadPreferences load_preferences(const std::filesystem::path& path);
/// Errors: the folder or file cannot be written. What was there before and load_preferences had
/// problems with is kept beside it, with ".old" appended.
Result<void> save_preferences(const std::filesystem::path& path, const SceneOptions& scene);

}  // namespace skerry::game
