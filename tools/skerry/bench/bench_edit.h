#pragma once
#include <filesystem>
#include <optional>

#include "game/scene_file/options.h"

namespace skerry::tools {

struct BenchEditOptions {
  game::SceneOptions scene;
  std::optional<std::filesystem::path> json;
};

/// Digs, puts up torches and takes them down in a loaded scene, and times each from the edit until
/// the first picture that shows it is finished on the GPU. Prints a row for each kind of edit and
/// writes them as JSON: name, size, edits, frames_median, frames_most, ms_median, ms_p90, ms_most,
/// frame_ms_median. @return exit status.
int bench_edit(const BenchEditOptions& options);

}  // namespace skerry::tools
