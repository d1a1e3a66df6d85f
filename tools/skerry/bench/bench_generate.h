#pragma once
#include <filesystem>
#include <optional>

namespace skerry::tools {

struct BenchGenerateOptions {
  std::optional<std::filesystem::path> json;
};

/// Times the generator on the islands around the origin of seed 1, at full detail, on one thread
/// and on all. JSON rows: threads, islands, chunks, plan_s (island plans), chunk_s,
/// chunks_per_s and blocks_per_s (64^3 blocks a chunk; plans included), bytes_per_chunk (as
/// stored).
/// @return exit status.
int bench_generate(const BenchGenerateOptions& options);

}  // namespace skerry::tools
