#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "game/scene_file/options.h"

namespace skerry::tools {

struct BenchShadeOptions {
  game::SceneText typed;            ///< over each scene
  std::vector<std::string> scenes;  ///< of shade_scenes(); empty: all
  std::optional<std::uint32_t> device;
  std::optional<std::filesystem::path> json;
};

/// Compares light that stays on faces with the reference, scene by scene, and pictures with it.
/// Rows: scene, and the fields of ShadeErrors, flip_mean and flip_p99 of the frame against the
/// reference at pixel centres. @return exit status.
int bench_shade(const BenchShadeOptions& options);

}  // namespace skerry::tools
