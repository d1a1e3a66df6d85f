#pragma once
#include <filesystem>
#include <optional>

#include "game/scene_file/options.h"

namespace skerry::tools {

struct BenchFlyOptions {
  game::SceneOptions scene;
  std::optional<double> speed;    ///< blocks/s; none: 48
  std::optional<double> seconds;  ///< none: 60
  std::optional<std::filesystem::path> json;
};

/// Flies straight ahead from the start at a fixed speed, in real time, through islands that nobody
/// has seen yet, streaming as play does, and times every frame. Prints the spread of the
/// frames' times, and how many took more than twice the median, with what the slowest of them
/// waited for. As JSON: name, size, speed, seconds, frames, ms_median, ms_p99, ms_max,
/// frames_over_2x, programs_made (that frames waited for), allocations (of device memory), those in
/// the flight's second half, world_bytes (most that the tables of the world had in use),
/// arena_holes (largest share of the room for quads that was free but not in its largest run),
/// `allocated`, each frame that made some with what the last was for, and `hitches`, each frame
/// over twice the median with its parts.
/// @return exit status.
int bench_fly(const BenchFlyOptions& options);

/// Opens a world as play does, and times from now until the first picture whose chunk under the
/// player, and those next to it, are meshed and there to stand on, until something of every island
/// within view distance is shown, and until everything is. Prints and writes as JSON: name, size,
/// device_ms, open_ms, view_ms, first_picture_ms, playable_ms, frames, islands, coarse_ms,
/// complete_ms. @return exit status.
int bench_start(const BenchFlyOptions& options);

}  // namespace skerry::tools
