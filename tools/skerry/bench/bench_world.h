#pragma once
#include <filesystem>
#include <optional>

namespace skerry::tools {

struct BenchWorldOptions {
  std::optional<std::filesystem::path> json;
};

/// Times what keeps and moves worlds, on one thread: saving 10,000 edits and opening the file,
/// finding and carrying out a split of an island of 10^6 blocks, a tick with 1,024 islands. JSON
/// rows: name, ms_median, ms_p10, ms_p90, and bytes, bricks, islands or pairs where they mean
/// something. @return exit status.
int bench_world(const BenchWorldOptions& options);

}  // namespace skerry::tools
