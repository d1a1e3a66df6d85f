#include <shader_names.h>
#include <algorithm>
#include <cstddef>

#include "engine/render/light/light_clusters.h"

#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {
namespace {

using gpu::Use;

/// A dispatch of one invocation an item, in work groups of 64, in rows that any device takes.
void dispatch_items(gpu::Commands& c, std::uint32_t items) {
  const std::uint32_t count = gpu::Commands::groups(items, shared::kClusterGroup);
  c.dispatch(std::min(count, shared::kTileRow), gpu::Commands::groups(count, shared::kTileRow), 1);
}

static_assert(offsetof(shared::TileDispatch, groups_z) == 8 &&
              offsetof(shared::ClusterWork, groups_z) == 8);

/// A dispatch without work groups, nothing counted. @param layers of work groups.
void fill_dispatch(gpu::Commands& c, gpu::BufferRef to, std::uint64_t size_bytes,
                   std::uint32_t layers) {
  c.fill(to, 0, 4, 0);
  c.fill(to, 4, 4, 1);
  c.fill(to, 8, 4, layers);
  c.fill(to, 12, size_bytes - 12, 0);
}

struct Buffers {
  gpu::BufferRef grid, lights, islands, reaches;
  gpu::BufferRef small_tiles, tiles;  ///< shared::TileDepths
  gpu::BufferRef bins, occupied, counts, work;
  ClusterDepths pixels;  ///< what the picture shows
  VkSampler point;
};

std::uint32_t small_tile_count(const shared::ClusterGrid& grid) {
  return gpu::Commands::groups(grid.size.x, shared::kTileEdge) *
         gpu::Commands::groups(grid.size.y, shared::kTileEdge);
}

/// What list_lights.comp works on besides Buffers; what a step does not use is bound to another of
/// its buffers.
struct Lists {
  gpu::BufferRef tiles, work, occupied, counts, clusters, dispatches, listed;

  auto bindings(const Buffers& b) const {
    const ClusterDepths& pixels = b.pixels;
    return std::tuple{
        gpu::storage<shared::kLightGridBinding>(b.grid),
        gpu::sampled<shared::kDepthsBinding>(pixels.depth, b.point),
        gpu::storage<shared::kSurfacesBinding>(pixels.surfaces),
        // Layers that are not there are never read; depth is bound in their place.
        gpu::each_of<shared::kLayerDepthsBinding, 4>([&]<std::uint32_t kBinding>(std::size_t k) {
          return gpu::sampled<kBinding>(k < pixels.layer_count ? pixels.layers[k] : pixels.depth,
                                        b.point);
        }),
        gpu::storage<shared::kTileDepthsBinding>(b.small_tiles),
        gpu::storage<shared::kGridTilesBinding>(tiles),
        gpu::storage<shared::kClusterWorkBinding>(work),
        gpu::storage<shared::kOccupiedClustersBinding>(occupied),
        gpu::storage<shared::kLightCountsBinding>(counts),
        gpu::storage<shared::kClustersBinding>(clusters),
        gpu::storage<shared::kTileDispatchesBinding>(dispatches),
        gpu::storage<shared::kTilesBinding>(listed)};
  }
};

/// What every step of list_lights.comp declares, whether it looks at it or not.
void declare_pixels(gpu::PassBuilder& p, Buffers& b) {
  p.read(b.pixels.surfaces, Use::kComputeRead);
  p.read(b.pixels.depth, Use::kComputeSampled);
  for (std::uint32_t k = 0; k < b.pixels.layer_count; ++k)
    p.read(b.pixels.layers[k], Use::kComputeSampled);
  b.small_tiles = p.write(b.small_tiles, Use::kComputeWrite);
}

auto list_program(gpu::Pipelines& pipelines, std::uint32_t list, const ClusterDepths& pixels,
                  bool oracle = false) {
  std::vector<gpu::SpecConstant> constants{{shared::kLightListConstant, list}};
  if (oracle) constants.push_back({shared::kOracleConstant, 1});
  if (list == shared::kListDepths) {
    constants.push_back({shared::kWaterLayersConstant, pixels.layer_count});
    if (pixels.depth16) constants.push_back({shared::kDepth16Constant, 1});
  }
  return gpu::compute(pipelines, programs::kListLights, std::move(constants));
}

/// Finds what depths each tile of 8x8 pixels shows.
void add_mark(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const shared::ClusterGrid& grid,
              Buffers& b) {
  graph.add_pass(
      "mark_light_tiles",
      [&](gpu::PassBuilder& p) {
        p.read(b.grid, Use::kComputeRead);
        declare_pixels(p, b);
      },
      [b, program = list_program(pipelines, shared::kListDepths, b.pixels),
       count = small_tile_count(grid)](gpu::Commands& c) {
        const gpu::BufferRef& unused = b.small_tiles;
        const Lists lists{unused, unused, unused, unused, unused, unused, unused};
        gpu::bind(c, program, lists.bindings(b));
        dispatch_items(c, count);
      });
}

void add_list_clusters(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                       const shared::ClusterGrid& grid, Buffers& b) {
  graph.add_pass(
      "list_light_clusters_clear",
      [&](gpu::PassBuilder& p) { b.work = p.write(b.work, Use::kTransferWrite); },
      [work = b.work, chunks = grid.chunks](gpu::Commands& c) {
        fill_dispatch(c, work, sizeof(shared::ClusterWork), chunks);
      });
  graph.add_pass(
      "list_light_clusters",
      [&](gpu::PassBuilder& p) {
        p.read(b.grid, Use::kComputeRead);
        declare_pixels(p, b);
        b.tiles = p.write(b.tiles, Use::kComputeWrite);
        b.work = p.write(b.work, Use::kComputeWrite);
        b.occupied = p.write(b.occupied, Use::kComputeWrite);
      },
      [b, count = grid.tiles_x * grid.tiles_y,
       program = list_program(pipelines, shared::kListClusters, b.pixels)](gpu::Commands& c) {
        const Lists lists{b.tiles,    b.work,     b.occupied, b.occupied,
                          b.occupied, b.occupied, b.occupied};
        gpu::bind(c, program, lists.bindings(b));
        dispatch_items(c, count);
      });
}

/// What assign_lights.comp works on besides Buffers; what a step does not use is bound to another.
struct Assigned {
  gpu::BufferRef work, occupied, counts, clusters, entries;

  auto bindings(const Buffers& b) const {
    return std::tuple{gpu::storage<shared::kLightGridBinding>(b.grid),
                      gpu::storage<shared::kLightsBinding>(b.lights),
                      gpu::storage<shared::kIslandsBinding>(b.islands),
                      gpu::storage<shared::kLightReachBinding>(b.reaches),
                      gpu::storage<shared::kGridTilesBinding>(b.tiles),
                      gpu::storage<shared::kLightBinsBinding>(b.bins),
                      gpu::storage<shared::kClusterWorkBinding>(work),
                      gpu::storage<shared::kOccupiedClustersBinding>(occupied),
                      gpu::storage<shared::kLightCountsBinding>(counts),
                      gpu::storage<shared::kClustersBinding>(clusters),
                      gpu::storage<shared::kLightEntriesBinding>(entries)};
  }
};

void add_bin(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const shared::ClusterGrid& grid,
             std::uint32_t kinds, Buffers& b) {
  graph.add_pass(
      "bin_lights",
      [&](gpu::PassBuilder& p) {
        for (const gpu::BufferRef ref : {b.grid, b.lights, b.islands, b.reaches, b.tiles})
          p.read(ref, Use::kComputeRead);
        b.bins = p.write(b.bins, Use::kComputeWrite);
      },
      [b, groups = gpu::Commands::groups(grid.bins_x * grid.bins_y, shared::kClusterGroup),
       words = grid.light_words,
       program = gpu::compute(pipelines, programs::kAssignLights,
                              {{shared::kLightKindsConstant, kinds}, {shared::kBinConstant, 1}})](
          gpu::Commands& c) {
        const Assigned in{b.bins, b.bins, b.bins, b.bins, b.bins};
        gpu::bind(c, program, in.bindings(b), gpu::constants(0u));
        c.dispatch(groups, words, 1);
      });
}

void add_reserve(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, Buffers& b,
                 ClusteredLights& out) {
  graph.add_pass(
      "reserve_light_lists",
      [&](gpu::PassBuilder& p) {
        p.read(b.grid, Use::kComputeRead);
        p.read(b.work, Use::kIndirect);
        declare_pixels(p, b);
        b.work = p.write(b.work, Use::kComputeWrite);
        // Read alone by this step, but the shader may write it.
        b.occupied = p.write(b.occupied, Use::kComputeWrite);
        b.counts = p.write(b.counts, Use::kComputeWrite);
        out.clusters = p.write(out.clusters, Use::kComputeWrite);
      },
      [b, clusters = out.clusters,
       program = list_program(pipelines, shared::kListRoom, b.pixels)](gpu::Commands& c) {
        const Lists lists{b.counts, b.work, b.occupied, b.counts, clusters, b.counts, b.counts};
        gpu::bind(c, program, lists.bindings(b));
        c.dispatch_indirect(b.work, 0);
      });
}

/// One of the two runs over the occupied clusters. In the first, the counts stand for what is not
/// there yet and not looked at.
void add_assign(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, bool list, Buffers& b,
                ClusteredLights& out) {
  graph.add_pass(
      list ? "assign_lights" : "count_lights",
      [&](gpu::PassBuilder& p) {
        for (const gpu::BufferRef ref :
             {b.grid, b.lights, b.islands, b.reaches, b.tiles, b.occupied, b.work})
          p.read(ref, Use::kComputeRead);
        b.bins = p.write(b.bins, Use::kComputeWrite);  // by the shader's other step
        p.read(b.work, Use::kIndirect);
        if (list) p.read(out.clusters, Use::kComputeRead);
        b.counts = p.write(b.counts, Use::kComputeWrite);
        if (list) out.entries = p.write(out.entries, Use::kComputeWrite);
      },
      [b, list, clusters = list ? out.clusters : b.counts, entries = list ? out.entries : b.counts,
       program = gpu::compute(pipelines, programs::kAssignLights,
                              {{shared::kLightKindsConstant, out.kinds}})](gpu::Commands& c) {
        const Assigned in{b.work, b.occupied, b.counts, clusters, entries};
        gpu::bind(c, program, in.bindings(b), gpu::constants(list ? 1u : 0u));
        c.dispatch_indirect(b.work, 0);
      });
}

/// What lights of most views need, so that their counts are not outgrown by each that comes.
constexpr std::uint32_t kUsualChunks = 8;

void add_list_tiles(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                    const shared::ClusterGrid& grid, Buffers& b, ClusteredLights& out) {
  graph.add_pass(
      "list_light_tiles_clear",
      [&](gpu::PassBuilder& p) {
        out.tiles.dispatches = p.write(out.tiles.dispatches, Use::kTransferWrite);
      },
      [dispatches = out.tiles.dispatches](gpu::Commands& c) {
        fill_dispatch(c, dispatches, 2 * sizeof(shared::TileDispatch), 1);
      });
  const gpu::BufferRef clusters = out.oracle ? out.tiles.lists : out.clusters;  // may be unread
  graph.add_pass(
      "list_light_tiles",
      [&](gpu::PassBuilder& p) {
        p.read(b.grid, Use::kComputeRead);
        declare_pixels(p, b);
        // Read alone by this step, but the shader may write them.
        if (!out.oracle) out.clusters = p.write(out.clusters, Use::kComputeWrite);
        out.tiles.dispatches = p.write(out.tiles.dispatches, Use::kComputeWrite);
        out.tiles.lists = p.write(out.tiles.lists, Use::kComputeWrite);
      },
      [b, clusters, tiles = out.tiles, count = small_tile_count(grid),
       program =
           list_program(pipelines, shared::kListTiles, b.pixels, out.oracle)](gpu::Commands& c) {
        const Lists lists{tiles.lists, tiles.lists,      tiles.lists, tiles.lists,
                          clusters,    tiles.dispatches, tiles.lists};
        gpu::bind(c, program, lists.bindings(b));
        dispatch_items(c, count);
      });
}

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
  out.kinds = kinds_;
  out.oracle = oracle;
  out.grid = graph.import(grid_buffer_);
  out.lights = graph.import(lights_);
  out.reaches = reaches_ ? graph.import(reaches_) : out.lights;
  out.tiles.dispatches = create("light tile dispatches", 2 * sizeof(shared::TileDispatch));
  out.tiles.lists = create("light tiles", std::uint64_t{small} * sizeof(std::uint32_t));
  Buffers b;
  b.grid = out.grid;
  b.lights = out.lights;
  b.islands = scene.islands;
  b.reaches = out.reaches;
  b.small_tiles = create("tile depths", std::uint64_t{small} * sizeof(shared::TileDepths));
  b.pixels = depths;
  b.point = scene.point_sampler;
  work_ = {};
  add_mark(graph, pipelines, grid_, b);
  if (!oracle) {
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
    add_bin(graph, pipelines, grid_, kinds_, b);
    add_assign(graph, pipelines, false, b, out);
    add_reserve(graph, pipelines, b, out);
    add_assign(graph, pipelines, true, b, out);
    work_ = b.work;
  }
  add_list_tiles(graph, pipelines, grid_, b, out);
  return out;
}

}  // namespace skerry::render
