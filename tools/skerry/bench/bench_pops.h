#pragma once
#include <filesystem>
#include <optional>

#include "game/scene_file/options.h"

namespace skerry::tools {

struct BenchPopsOptions {
  game::SceneOptions scene;
  std::optional<int> frames;    ///< none: 600
  std::optional<double> speed;  ///< blocks/s at 60 frames/s; none: 48
  std::optional<std::filesystem::path> json;
};

/// Flies straight ahead from the start and draws each frame twice: with what streaming and levels
/// of detail had chosen for the frame before, and with what they choose now, a frame further on in
/// the changes that are under way, as in play. All that differs is what a change of level shows in
/// one frame. Prints the worst frames and writes as JSON: name, device, size,
/// frames, speed, changed (frames in which a pixel differs), over (those in which more than 0.5% of
/// the pixels differ by more than 8/255), worst and mean (share of the pixels that do, in one frame
/// and in all), and `pops`, each frame that is over: at_blocks, share, largest [1/255], camera.
/// Exposure is that of the first frame. @return exit status.
int bench_pops(const BenchPopsOptions& options);

}  // namespace skerry::tools
