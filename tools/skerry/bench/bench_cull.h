#pragma once
#include <filesystem>
#include <optional>

#include "game/scene_file/options.h"

namespace skerry::tools {

struct BenchCullOptions {
  std::optional<std::uint32_t> device;
  bool validate = false;
  std::optional<std::filesystem::path> json;
};

/// Times the culling passes over 1,000 to 1,000,000 sections spread around the camera. Rows:
/// sections, passed, ms_median, ms_p10, ms_p90, sections_per_ms. @return exit status.
int bench_cull(const BenchCullOptions& options);

}  // namespace skerry::tools
