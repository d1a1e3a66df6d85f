#pragma once
#include <filesystem>
#include <optional>

#include "game/scene_file/options.h"

namespace skerry::tools {

struct BenchFlickerOptions {
  game::SceneOptions scene;
  std::optional<int> frames;  ///< of each motion; none: 120
  std::optional<std::filesystem::path> json;
};

/// Draws a slow turn, a walk, a drift of the islands and 24 times the sun's way frame by frame,
/// each frame also with 16 samples a pixel (aa.samples=16), and counts pixels that change otherwise
/// than those do. Prints a row for each motion and writes it as JSON: name, motion, device, size,
/// frames, and as shares of the pixels changed, truly_changed, flicker, flicker_worst, that of the
/// worst pair of frames, and stepped; largest_step in 1/255. See measure::FlickerCounts and
/// StepCounts.
/// @return exit status.
int bench_flicker(const BenchFlickerOptions& options);

}  // namespace skerry::tools
