#pragma once
#include <filesystem>
#include <optional>

namespace skerry::tools {

struct BenchMeshOptions {
  std::optional<std::filesystem::path> input;  ///< folder of .bin sets; none: chunks of seed 1
  std::optional<std::filesystem::path> json;
};

/// Times the mesher on one thread and prints a table; JSON rows: kind, edge, us_median, us_p10,
/// us_p90 (over chunks, of each chunk's median), quads, faces (means a chunk), bytes_per_quad.
///
/// A set holds 64 chunks of edge^3 bytes, z fastest, y slowest. Edge 66: the outer layer is the
/// shell. A smaller edge is padded: all of it is meshed, from the chunk's corner, and the outermost
/// voxels are repeated to fill what is left. Every id but 0 counts as opaque.
/// Chunks are visited in turn, so that each comes from the last-level cache. The rows `empty` and
/// `solid` are marked so by their palette, as stored chunks are; `empty_ids` and `solid_ids` are
/// not.
/// @return exit status.
int bench_mesh(const BenchMeshOptions& options);

}  // namespace skerry::tools
