#include "tools/skerry/bench/bench_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "tools/skerry/bench/bench_report.h"
#include "tools/skerry/scene/scene_device.h"
#include "world/generate/generate.h"
#include "world/mesh/kernel.h"
#include "world/mesh/mesh.h"

namespace skerry::tools {
namespace {

using namespace world;

constexpr std::size_t kChunksInSet = 64;
constexpr int kWarmPasses = 2, kMeshPasses = 9;
constexpr BlockId kOpaqueIds = 0x4000;  // ids beyond the block table count as opaque

/// Chunks to mesh: bytes with a palette, or ids.
struct ChunkSet {
  std::string kind;
  int edge = kPaddedEdge;
  std::vector<std::vector<std::uint8_t>> bytes;
  std::vector<BlockId> palette;
  std::vector<std::vector<BlockId>> ids;
  std::size_t size() const { return std::max(bytes.size(), ids.size()); }
};

/// The edge of a set's chunks, or 0.
int edge_of(std::uintmax_t file_bytes) {
  for (std::uintmax_t edge = 1; edge <= kPaddedEdge; ++edge) {
    if (edge * edge * edge * kChunksInSet == file_bytes) return static_cast<int>(edge);
  }
  return 0;
}

/// Chunk `index` of a set, with a shell.
std::vector<std::uint8_t> padded_chunk(const std::vector<char>& file, int edge, std::size_t index) {
  std::vector<std::uint8_t> padded;
  padded.reserve(kPaddedVoxels);
  const auto base = index * static_cast<std::size_t>(edge) * edge * edge;
  const auto inside = [edge](int i) {
    return edge == kPaddedEdge ? i : std::clamp(i - 1, 0, edge - 1);
  };
  for (int y = 0; y < kPaddedEdge; ++y) {
    for (int x = 0; x < kPaddedEdge; ++x) {
      for (int z = 0; z < kPaddedEdge; ++z) {
        const int at = inside(z) + edge * (inside(x) + edge * inside(y));
        padded.push_back(static_cast<std::uint8_t>(file[base + static_cast<std::size_t>(at)]));
      }
    }
  }
  return padded;
}

Result<ChunkSet> read_set(const std::filesystem::path& path) {
  std::error_code failed;
  const std::uintmax_t size = std::filesystem::file_size(path, failed);
  ChunkSet set;
  set.kind = path.stem().string();
  set.edge = failed ? 0 : edge_of(size);
  if (set.edge == 0) {
    return Error{
        fmt::format("cannot mesh {}: a set is 64 cubes of bytes of an edge up to {}; "
                    "write it with gen --size {}",
                    path.string(), kPaddedEdge, kPaddedEdge)};
  }
  std::vector<char> file(size);
  std::ifstream stream(path, std::ios::binary);
  if (!stream.read(file.data(), static_cast<std::streamsize>(size))) {
    return Error{fmt::format("cannot read {}: check that it is readable", path.string())};
  }
  for (std::size_t i = 0; i < kChunksInSet; ++i) {
    set.bytes.push_back(padded_chunk(file, set.edge, i));
  }
  set.palette = {kAir};
  for (int id = 1; id < 256; ++id) set.palette.push_back(static_cast<BlockId>(kOpaqueIds + id));
  std::uint8_t largest = 0;
  for (const auto& chunk : set.bytes) {
    largest = std::max(largest, *std::max_element(chunk.begin(), chunk.end()));
  }
  set.palette.resize(std::size_t{largest} + 1);
  return set;
}

Result<std::vector<ChunkSet>> read_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
    if (entry.path().extension() == ".bin") files.push_back(entry.path());
  }
  if (files.empty()) {
    return Error{
        fmt::format("cannot find chunk sets in {}: give a folder of .bin files", folder.string())};
  }
  std::sort(files.begin(), files.end());
  std::vector<ChunkSet> sets;
  for (const auto& file : files) {
    Result<ChunkSet> set = read_set(file);
    if (!set) return set.error();
    sets.push_back(std::move(*set));
  }
  return sets;
}

/// Chunks of the islands nearest to the origin of seed 1 that are not all air.
ChunkSet generated_set() {
  ChunkSet set;
  set.kind = "generated";
  for (const IslandSpec& spec : islands_within(1, {}, 2000.0)) {
    const IslandGenerator generator(spec);
    for (const IVec3& chunk : generator.chunks(0)) {
      std::vector<BlockId> padded(kPaddedVoxels);
      if (generator.generate_padded(chunk, 0, padded)) set.ids.push_back(std::move(padded));
      if (set.ids.size() == kChunksInSet) return set;
    }
  }
  return set;
}

std::vector<ChunkSet> uniform_sets() {
  std::vector<ChunkSet> sets;
  for (const BlockId id : {kAir, BlockId{block::kStone}}) {
    const std::string kind = id == kAir ? "empty" : "solid";
    ChunkSet& told = sets.emplace_back();
    told.kind = kind;
    told.bytes.assign(kChunksInSet, std::vector<std::uint8_t>(kPaddedVoxels));
    told.palette = {id};
    ChunkSet& untold = sets.emplace_back();
    untold.kind = kind + "_ids";
    untold.ids.assign(kChunksInSet, std::vector<BlockId>(kPaddedVoxels, id));
  }
  return sets;
}

struct Timed {
  Spread us;
  double quads = 0.0, faces = 0.0;  // means a chunk
};

Timed time_set(const ChunkSet& set) {
  using Clock = std::chrono::steady_clock;
  MeshScratch scratch;
  ChunkMesh mesh;
  Timed timed;
  std::vector<std::vector<double>> times(set.size());
  for (int pass = 0; pass < kWarmPasses + kMeshPasses; ++pass) {
    for (std::size_t i = 0; i < set.size(); ++i) {
      const Clock::time_point start = Clock::now();
      if (set.ids.empty()) {
        mesh_chunk(set.bytes[i], set.palette, scratch, mesh);
      } else {
        mesh_chunk(set.ids[i], scratch, mesh);
      }
      const std::chrono::duration<double, std::micro> taken = Clock::now() - start;
      if (pass >= kWarmPasses) times[i].push_back(taken.count());
      if (pass > 0) continue;
      timed.quads += static_cast<double>(mesh.quads.size());
      for (const shared::Quad& quad : mesh.quads) {
        timed.faces += ((quad.geometry >> 18 & 63) + 1.0) * ((quad.geometry >> 24 & 63) + 1.0);
      }
    }
  }
  std::vector<double> medians;
  for (std::vector<double>& of_chunk : times) {
    medians.push_back(spread_of(std::move(of_chunk)).median);
  }
  timed.us = spread_of(std::move(medians));
  timed.quads /= static_cast<double>(set.size());
  timed.faces /= static_cast<double>(set.size());
  return timed;
}

}  // namespace

int bench_mesh(const BenchMeshOptions& options) {
  std::vector<ChunkSet> sets;
  if (options.input) {
    Result<std::vector<ChunkSet>> read = read_folder(*options.input);
    if (!read) return fail(kFailed, read.error());
    sets = std::move(*read);
  } else {
    sets.push_back(generated_set());
  }
  for (ChunkSet& set : uniform_sets()) sets.push_back(std::move(set));
  fmt::print("one thread, {} kernel\n", mesh_detail::kernels().front()->name);
  fmt::print("{:>14} {:>5} {:>10} {:>9} {:>9} {:>9} {:>9} {:>12}\n", "kind", "edge", "us median",
             "us p10", "us p90", "quads", "faces", "bytes a quad");
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ChunkSet& set : sets) {
    const Timed timed = time_set(set);
    fmt::print("{:>14} {:>5} {:>10.2f} {:>9.2f} {:>9.2f} {:>9.0f} {:>9.0f} {:>12}\n", set.kind,
               set.edge, timed.us.median, timed.us.p10, timed.us.p90, timed.quads, timed.faces,
               sizeof(shared::Quad));
    rows.push_back({{"kind", set.kind},
                    {"edge", set.edge},
                    {"us_median", timed.us.median},
                    {"us_p10", timed.us.p10},
                    {"us_p90", timed.us.p90},
                    {"quads", timed.quads},
                    {"faces", timed.faces},
                    {"bytes_per_quad", sizeof(shared::Quad)}});
  }
  if (Result<void> written = write_rows(options.json, rows); !written) {
    return fail(kFailed, written.error());
  }
  return kDone;
}

}  // namespace skerry::tools
