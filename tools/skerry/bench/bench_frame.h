#pragma once
#include <filesystem>
#include <optional>

#include "game/scene_file/options.h"

namespace skerry::tools {

struct BenchFrameOptions {
  game::SceneOptions scene;
  std::optional<std::filesystem::path> json;
  double clock_rate = 0.0;  ///< seconds of the day that pass in one
};

/// Times whole frames of a loaded scene in a loop with a slowly turning camera, while the clock
/// runs as in play. Prints a row and writes it as JSON: name, size, distance, shadows, ms_median,
/// ms_p10, ms_p99, ms_max, frames_over_2x, fps_median, programs_made (that frames waited for),
/// allocations (of device memory), gpu_ms{} of the first of these frames drawn again. @return exit
/// status.
int bench_frame(const BenchFrameOptions& options);

}  // namespace skerry::tools
