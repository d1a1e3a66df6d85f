#include "tools/skerry/bench/bench_generate.h"

#include <fmt/format.h>

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "engine/core/clock.h"
#include "engine/core/jobs.h"
#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/scene/scene_device.h"
#include "world/generate/far_island.h"
#include "world/generate/generate.h"
#include "world/islands/world.h"
#include "world/mesh/mesh.h"

namespace skerry::tools {
namespace {

using namespace world;

constexpr std::uint64_t kSeed = 1;
constexpr double kRadiusBlocks = 600.0;
constexpr std::size_t kFarRounds = 64;  // of islands that take microseconds

struct Place {
  std::size_t island;
  IVec3 chunk;
  int level = 0;
};

/// What a thread meshes with.
struct Meshing {
  std::vector<BlockId> voxels = std::vector<BlockId>(kPaddedVoxels);
  MeshScratch scratch;
  ChunkMesh mesh;
};

struct Measured {
  std::size_t islands = 0, chunks = 0;
  double plan_s = 0.0, chunk_s = 0.0, coarse_s = 0.0, mesh_s = 0.0, far_s = 0.0;
  std::size_t stored_bytes = 0;
};

/// Calls body(i) for i in [0, count), each thread taking the next one; `make` gives each thread its
/// own working memory.
template <class Make, class Body>
void on_all_threads(Jobs& jobs, std::size_t count, const Make& make, const Body& body) {
  std::atomic<std::size_t> next{0};
  jobs.parallel_for(jobs.threads(), [&](int) {
    auto memory = make();
    for (std::size_t i = next++; i < count; i = next++) body(i, memory);
  });
}

Measured measure(int threads) {
  Jobs jobs(threads);
  const std::vector<IslandSpec> specs = islands_within(kSeed, {}, kRadiusBlocks);
  std::vector<std::optional<IslandGenerator>> generators(specs.size());
  Measured measured;
  measured.islands = specs.size();
  Stopwatch watch;
  on_all_threads(
      jobs, specs.size(), [] { return 0; },
      [&](std::size_t i, int) { generators[i].emplace(specs[i]); });
  measured.plan_s = watch.seconds();
  std::vector<Place> places;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    for (const IVec3& chunk : generators[i]->chunks(0)) places.push_back({i, chunk, 0});
  }
  measured.chunks = places.size();
  watch.restart();
  on_all_threads(
      jobs, places.size(), [] { return std::vector<BlockId>(kPaddedVoxels); },
      [&](std::size_t i, std::vector<BlockId>& voxels) {
        generators[places[i].island]->generate_padded(places[i].chunk, 0, voxels);
      });
  measured.chunk_s = watch.seconds();
  std::vector<Place> coarse;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    for (int level = 1; level < kLevelCount; ++level)
      for (const IVec3& chunk : generators[i]->chunks(level)) coarse.push_back({i, chunk, level});
  }
  watch.restart();
  on_all_threads(
      jobs, coarse.size(), [] { return std::vector<BlockId>(kPaddedVoxels); },
      [&](std::size_t i, std::vector<BlockId>& voxels) {
        const Place& place = coarse[i];
        generators[place.island]->generate_padded(place.chunk, place.level, voxels);
      });
  measured.coarse_s = watch.seconds();
  watch.restart();
  on_all_threads(
      jobs, places.size(), [] { return std::make_unique<Meshing>(); },
      [&](std::size_t i, std::unique_ptr<Meshing>& of) {
        generators[places[i].island]->generate_padded(places[i].chunk, 0, of->voxels);
        mesh_chunk(of->voxels, of->scratch, of->mesh);
      });
  measured.mesh_s = watch.seconds() - measured.chunk_s;
  watch.restart();
  on_all_threads(
      jobs, specs.size() * kFarRounds, [] { return ChunkMesh{}; },
      [&](std::size_t i, ChunkMesh& mesh) {
        const IslandSpec& spec = specs[i % specs.size()];
        far_island(spec, far_voxel_log2(spec, kLevelCount), mesh);
      });
  measured.far_s = watch.seconds() / kFarRounds;
  std::vector<BlockId> voxels(kPaddedVoxels);
  for (const Place& place : places) {
    generators[place.island]->generate_padded(place.chunk, 0, voxels);
    measured.stored_bytes += chunk_from_padded(voxels).size_bytes();
  }
  return measured;
}

}  // namespace

int bench_generate(const BenchGenerateOptions& options) {
  fmt::print("{:>7} {:>8} {:>7} {:>8} {:>8} {:>9} {:>14} {:>14} {:>9} {:>9} {:>9}\n", "threads",
             "islands", "chunks", "plan s", "chunk s", "chunks/s", "blocks/s", "bytes a chunk",
             "near ms", "coarse ms", "far ms");
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::vector<int> thread_counts{1};
  if (const int all = Jobs().threads(); all > 1) thread_counts.push_back(all);
  for (const int threads : thread_counts) {
    const Measured m = measure(threads);
    const double chunks = static_cast<double>(m.chunks);
    const double chunks_per_s = chunks / (m.plan_s + m.chunk_s);
    const double blocks_per_s = chunks_per_s * static_cast<double>(kChunkVoxels);
    const double islands = static_cast<double>(m.islands) / 1000.0;
    const double near_ms = (m.plan_s + m.chunk_s + m.mesh_s) / islands, far_ms = m.far_s / islands,
                 coarse_ms = m.coarse_s / islands;
    const double bytes = static_cast<double>(m.stored_bytes) / chunks;
    fmt::print(
        "{:>7} {:>8} {:>7} {:>8.3f} {:>8.3f} {:>9.0f} {:>14.0f} {:>14.0f} {:>9.3f} {:>9.3f} "
        "{:>9.3f}\n",
        threads, m.islands, m.chunks, m.plan_s, m.chunk_s, chunks_per_s, blocks_per_s, bytes,
        near_ms, coarse_ms, far_ms);
    rows.push_back({{"threads", threads},
                    {"islands", m.islands},
                    {"chunks", m.chunks},
                    {"plan_s", m.plan_s},
                    {"chunk_s", m.chunk_s},
                    {"chunks_per_s", chunks_per_s},
                    {"blocks_per_s", blocks_per_s},
                    {"bytes_per_chunk", bytes},
                    {"near_ms_per_island", near_ms},
                    {"coarse_ms_per_island", coarse_ms},
                    {"far_ms_per_island", far_ms}});
  }
  if (Result<void> written = write_rows(options.json, rows); !written) {
    return fail(kFailed, written.error());
  }
  return kDone;
}

}  // namespace skerry::tools
