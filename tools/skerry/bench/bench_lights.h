#pragma once
#include <filesystem>
#include <optional>

#include "game/scene_file/options.h"

namespace skerry::tools {

struct BenchLightsOptions {
  game::SceneOptions scene;
  std::optional<std::filesystem::path> json;
};

/// Times the light passes of a scene with 64 to 16,384 torches scattered on what its camera sees.
/// Rows: lights (asked for), lights_in_view, lights_a_cluster (mean of those that show a surface),
/// sort_ms and shade_ms (median, p10, p90: sums over passes), gpu_ms{} (median of each light pass).
/// @return exit status.
int bench_lights(const BenchLightsOptions& options);

}  // namespace skerry::tools
