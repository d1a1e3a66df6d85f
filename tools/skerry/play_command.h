#pragma once
#include <string>
#include <vector>

#include "game/scene_file/options.h"

namespace skerry::tools {

/// Opens a window and plays until it is closed. @return the exit status of the command-line
/// contract; failures print one line on stderr. @param at_title, notes see game::play.
int play_command(const game::SceneOptions& scene, bool at_title,
                 const std::vector<std::string>& notes);

}  // namespace skerry::tools
