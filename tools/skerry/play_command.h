#pragma once
#include "game/options.h"

namespace skerry::tools {

/// Opens a window and plays until it is closed. @return the exit status of the command-line
/// contract; failures print one line on stderr.
int play_command(const game::SceneOptions& scene);

}  // namespace skerry::tools
