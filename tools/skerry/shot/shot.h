#pragma once
#include <filesystem>
#include <optional>

#include "game/scene_file/options.h"

namespace skerry::tools {

struct ShotOptions {
  game::SceneOptions scene;
  std::filesystem::path out = "skerry.png";
  std::optional<std::filesystem::path> stats;  ///< JSON
  bool explain = false;                        ///< print what the frame ran and what it left out
};

/// One deterministic picture. @return the exit status of the command-line contract; failures print
/// one line on stderr.
int shot(const ShotOptions& options);

}  // namespace skerry::tools
