#include <shader_names.h>
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "engine/render/light/light_clusters.h"

#include "engine/gpu/graph/bindings.h"
#include "engine/render/scene/tiles.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {
namespace {

using gpu::Use;

static_assert(shared::kClusterGroup == 64);  // of dispatch_items()

/// A dispatch without work groups, nothing counted. @param layers of work groups.
void clear_work(gpu::Commands& c, gpu::BufferRef work, std::uint32_t layers) {
  c.fill(work, offsetof(shared::ClusterWork, groups_x), 4, 0);
  c.fill(work, offsetof(shared::ClusterWork, groups_y), 4, 1);
  c.fill(work, offsetof(shared::ClusterWork, groups_z), 4, layers);
  constexpr std::uint64_t kCounted = offsetof(shared::ClusterWork, clusters);
  c.fill(work, kCounted, sizeof(shared::ClusterWork) - kCounted, 0);
}

/// What every step of sort_lights.comp reads, whether it looks at it or not.
struct Inputs {
  gpu::BufferRef grid, lights, islands, reaches;
  ClusterDepths pixels;  ///< what the picture shows
  VkSampler point;

  void declare(gpu::PassBuilder& p) const {
    for (const gpu::BufferRef ref : {grid, lights, islands, reaches})
      p.read(ref, Use::kComputeRead);
    p.read(pixels.surfaces, Use::kComputeRead);
    p.read(pixels.depth, Use::kComputeSampled);
    for (std::uint32_t k = 0; k < pixels.layer_count; ++k)
      p.read(pixels.layers[k], Use::kComputeSampled);
  }
  auto bindings() const {
    return std::tuple{
        gpu::storage<shared::kLightGridBinding>(grid), gpu::texels<shared::kLightsBinding>(lights),
        gpu::texels<shared::kIslandsBinding>(islands),
        gpu::storage<shared::kLightReachBinding>(reaches),
        gpu::sampled<shared::kDepthsBinding>(pixels.depth, point),
        gpu::storage<shared::kSurfacesBinding>(pixels.surfaces),
        // Layers that are not there are never read; depth is bound in their place.
        gpu::each_of<shared::kLayerDepthsBinding, 4>([&]<std::uint32_t kBinding>(std::size_t k) {
          return gpu::sampled<kBinding>(k < pixels.layer_count ? pixels.layers[k] : pixels.depth,
                                        point);
        })};
  }
};

/// What a step of sort_lights.comp works on and may write.
struct Lists {
  /// @param unused stands for all that the step has no use for: a buffer that it writes.
  explicit Lists(gpu::BufferRef unused)
      : small_tiles(unused),
        tiles(unused),
        bins(unused),
        work(unused),
        occupied(unused),
        counts(unused),
        clusters(unused),
        entries(unused) {}

  gpu::BufferRef small_tiles, tiles;  ///< shared::TileDepths
  gpu::BufferRef bins, work, occupied, counts, clusters, entries;

  auto bindings() const {
    return std::tuple{gpu::storage<shared::kTileDepthsBinding>(small_tiles),
                      gpu::storage<shared::kGridTilesBinding>(tiles),
                      gpu::storage<shared::kLightBinsBinding>(bins),
                      gpu::storage<shared::kClusterWorkBinding>(work),
                      gpu::storage<shared::kOccupiedClustersBinding>(occupied),
                      gpu::storage<shared::kLightCountsBinding>(counts),
                      gpu::storage<shared::kClustersBinding>(clusters),
                      gpu::storage<shared::kLightEntriesBinding>(entries)};
  }
};

struct Buffers {
  Inputs in;
  gpu::BufferRef small_tiles, tiles;  ///< shared::TileDepths
  gpu::BufferRef bins, occupied, counts, work;
};

std::uint32_t small_tile_count(const shared::ClusterGrid& grid) {
  return tile_count({grid.size.x, grid.size.y});
}

auto program_of(gpu::Pipelines& pipelines, std::uint32_t step,
                std::vector<gpu::SpecConstant> constants) {
  constants.push_back({shared::kLightStepConstant, step});
  return gpu::compute(pipelines, programs::kSortLights, std::move(constants));
}

/// Finds what depths each tile of 8x8 pixels shows.
void add_mark(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const shared::ClusterGrid& grid,
              Buffers& b) {
  const ClusterDepths& pixels = b.in.pixels;
  std::vector<gpu::SpecConstant> constants{{shared::kWaterLayersConstant, pixels.layer_count}};
  if (pixels.depth16) constants.push_back({shared::kDepth16Constant, 1});
  graph.add_pass(
      "mark_light_tiles",
      [&](gpu::PassBuilder& p) {
        b.in.declare(p);
        b.small_tiles = p.write(b.small_tiles, Use::kComputeWrite);
      },
      [in = b.in, lists = Lists(b.small_tiles), count = small_tile_count(grid),
       program =
           program_of(pipelines, shared::kLightDepths, std::move(constants))](gpu::Commands& c) {
        gpu::bind(c, program, in.bindings(), lists.bindings(), gpu::constants(0u));
        dispatch_items(c, count);
      });
}

void add_list_clusters(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                       const shared::ClusterGrid& grid, Buffers& b) {
  graph.add_pass(
      "list_light_clusters_clear",
      [&](gpu::PassBuilder& p) { b.work = p.write(b.work, Use::kTransferWrite); },
      [work = b.work, chunks = grid.chunks](gpu::Commands& c) { clear_work(c, work, chunks); });
  Lists lists(b.occupied);
  lists.small_tiles = b.small_tiles;
  lists.tiles = b.tiles;
  lists.work = b.work;
  graph.add_pass(
      "list_light_clusters",
      [&](gpu::PassBuilder& p) {
        b.in.declare(p);
        // Read alone by this step, but the shader may write it: so in the steps below.
        b.small_tiles = p.write(b.small_tiles, Use::kComputeWrite);
        b.tiles = p.write(b.tiles, Use::kComputeWrite);
        b.work = p.write(b.work, Use::kComputeWrite);
        b.occupied = p.write(b.occupied, Use::kComputeWrite);
      },
      [in = b.in, lists, count = grid.tiles_x * grid.tiles_y,
       program = program_of(pipelines, shared::kLightClusters, {})](gpu::Commands& c) {
        gpu::bind(c, program, in.bindings(), lists.bindings(), gpu::constants(0u));
        dispatch_items(c, count);
      });
}

void add_bin(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const shared::ClusterGrid& grid,
             std::uint32_t kinds, Buffers& b) {
  Lists lists(b.bins);
  lists.tiles = b.tiles;
  graph.add_pass(
      "bin_lights",
      [&](gpu::PassBuilder& p) {
        b.in.declare(p);
        b.tiles = p.write(b.tiles, Use::kComputeWrite);
        b.bins = p.write(b.bins, Use::kComputeWrite);
      },
      [in = b.in, lists,
       groups = gpu::Commands::groups(grid.bins_x * grid.bins_y, shared::kClusterGroup),
       words = grid.light_words,
       program = program_of(pipelines, shared::kLightBins, {{shared::kLightKindsConstant, kinds}})](
          gpu::Commands& c) {
        gpu::bind(c, program, in.bindings(), lists.bindings(), gpu::constants(0u));
        c.dispatch(groups, words, 1);
      });
}

void add_reserve(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, Buffers& b,
                 ClusteredLights& out) {
  Lists lists(b.counts);
  lists.work = b.work;
  lists.occupied = b.occupied;
  lists.clusters = out.clusters;
  graph.add_pass(
      "reserve_light_lists",
      [&](gpu::PassBuilder& p) {
        b.in.declare(p);
        p.read(b.work, Use::kIndirect);
        b.work = p.write(b.work, Use::kComputeWrite);
        b.occupied = p.write(b.occupied, Use::kComputeWrite);
        b.counts = p.write(b.counts, Use::kComputeWrite);
        out.clusters = p.write(out.clusters, Use::kComputeWrite);
      },
      [in = b.in, lists, work = b.work,
       program = program_of(pipelines, shared::kLightRoom, {})](gpu::Commands& c) {
        gpu::bind(c, program, in.bindings(), lists.bindings(), gpu::constants(0u));
        c.dispatch_indirect(work, 0);
      });
}

/// One of the two runs over the occupied clusters. @param list else lights are counted.
void add_assign(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, bool list, Buffers& b,
                ClusteredLights& out) {
  Lists lists(b.counts);
  lists.tiles = b.tiles;
  lists.bins = b.bins;
  lists.work = b.work;
  lists.occupied = b.occupied;
  if (list) {
    lists.clusters = out.clusters;
    lists.entries = out.entries;
  }
  graph.add_pass(
      list ? "assign_lights" : "count_lights",
      [&](gpu::PassBuilder& p) {
        b.in.declare(p);
        p.read(b.work, Use::kIndirect);
        for (gpu::BufferRef* ref : {&b.tiles, &b.bins, &b.work, &b.occupied, &b.counts})
          *ref = p.write(*ref, Use::kComputeWrite);
        if (!list) return;
        out.clusters = p.write(out.clusters, Use::kComputeWrite);
        out.entries = p.write(out.entries, Use::kComputeWrite);
      },
      [in = b.in, lists, list, work = b.work,
       program = program_of(pipelines, shared::kLightLists,
                            {{shared::kLightKindsConstant, out.kinds}})](gpu::Commands& c) {
        gpu::bind(c, program, in.bindings(), lists.bindings(), gpu::constants(list ? 1u : 0u));
        c.dispatch_indirect(work, 0);
      });
}

/// What lights of most views need, so that their counts are not outgrown by each that comes.
constexpr std::uint32_t kUsualChunks = 8;

}  // namespace

ClusteredLights LightClusters::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                   const SceneRefs& scene, const ClusterDepths& depths,
                                   bool oracle) {
  const std::uint32_t tiles = grid_.tiles_x * grid_.tiles_y, small = small_tile_count(grid_);
  const std::uint64_t clusters = std::uint64_t{tiles} * shared::kClusterSlices;
  const auto create = [&](const char* name, std::uint64_t size_bytes) {
    return graph.create(gpu::BufferDesc{name, size_bytes, 0, gpu::Memory::kDevice});
  };
  ClusteredLights out;
  out.kinds = kinds_ & ~shared::kLightPanesBit;
  out.panes = (kinds_ & shared::kLightPanesBit) != 0;
  out.oracle = oracle;
  out.grid = graph.import(grid_buffer_);
  out.lights = graph.import(lights_);
  out.reaches = reaches_ ? graph.import(reaches_) : out.lights;
  work_ = {};
  if (oracle) {
    out.clusters = out.entries = out.tile_depths = out.lights;
    return out;
  }
  Buffers b;
  b.in = {out.grid, out.lights, scene.islands, out.reaches, depths, scene.point_sampler};
  b.small_tiles = create("tile depths", std::uint64_t{small} * sizeof(shared::TileDepths));
  add_mark(graph, pipelines, grid_, b);
  b.tiles = create("cluster depths", std::uint64_t{tiles} * sizeof(shared::TileDepths));
  b.work = create("cluster work", sizeof(shared::ClusterWork));
  b.occupied = create("occupied clusters", clusters * sizeof(std::uint32_t));
  b.counts = create("light counts",
                    clusters * std::max(grid_.chunks, kUsualChunks) * sizeof(std::uint32_t));
  b.bins = create("light bins", std::uint64_t{grid_.bins_x} * grid_.bins_y * grid_.light_words *
                                    sizeof(std::uint32_t));
  out.clusters = create("clusters", clusters * sizeof(shared::Cluster));
  out.entries = graph.import(entries_);
  add_list_clusters(graph, pipelines, grid_, b);
  add_bin(graph, pipelines, grid_, out.kinds, b);
  add_assign(graph, pipelines, false, b, out);
  add_reserve(graph, pipelines, b, out);
  add_assign(graph, pipelines, true, b, out);
  work_ = b.work;
  out.tile_depths = b.small_tiles;
  return out;
}

}  // namespace skerry::render
