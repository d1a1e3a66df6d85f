#include "engine/render/scene/tiles.h"

#include <shader_names.h>
#include <algorithm>
#include <cstddef>
#include <string>

#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/frame.h"

namespace skerry::render {

using gpu::Use;

Tiles classify_tiles(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                     const char* name, const Coverage& coverage) {
  const VkExtent2D size = scene.size;
  const std::uint32_t columns = gpu::Commands::groups(size.width, shared::kTileEdge);
  const std::uint32_t rows = gpu::Commands::groups(size.height, shared::kTileEdge);
  Tiles out;
  out.dispatches = graph.create(gpu::BufferDesc{"tile dispatches", 2 * sizeof(shared::TileDispatch),
                                                0, gpu::Memory::kDevice});
  out.lists = graph.create(gpu::BufferDesc{"tile lists", std::uint64_t{2} * columns * rows * 4, 0,
                                           gpu::Memory::kDevice});
  graph.add_pass(
      std::string(name) + "_clear",
      [&](gpu::PassBuilder& b) { out.dispatches = b.write(out.dispatches, Use::kTransferWrite); },
      [dispatches = out.dispatches](gpu::Commands& c) {
        for (std::uint64_t kind = 0; kind < 2; ++kind) {
          const std::uint64_t base = kind * sizeof(shared::TileDispatch);
          c.fill(dispatches, base + offsetof(shared::TileDispatch, groups_x), 4, 0);
          c.fill(dispatches, base + offsetof(shared::TileDispatch, groups_y), 8, 1);
          c.fill(dispatches, base + offsetof(shared::TileDispatch, tiles), 4, 0);
        }
      });
  graph.add_pass(
      name,
      [&](gpu::PassBuilder& b) {
        b.read(coverage.words, Use::kComputeRead);
        b.read(coverage.depth, Use::kComputeSampled);
        out.dispatches = b.write(out.dispatches, Use::kComputeWrite);
        out.lists = b.write(out.lists, Use::kComputeWrite);
      },
      [coverage, out, columns, rows, size, sampler = scene.point_sampler,
       program = gpu::compute(pipelines, programs::kClassifyTiles,
                              coverage.kept == DepthStore::kD16
                                  ? std::vector<gpu::SpecConstant>{{shared::kDepth16Constant, 1}}
                                  : std::vector<gpu::SpecConstant>{})](gpu::Commands& c) {
        const struct {
          std::uint32_t width, height, columns, rows;
          glm::uvec4 area;
        } push{size.width, size.height, columns, rows, coverage.area};
        gpu::bind(c, program, gpu::storage<shared::kSurfacesBinding>(coverage.words),
                  gpu::sampled<shared::kDepthsBinding>(coverage.depth, sampler),
                  gpu::storage<shared::kTileDispatchesBinding>(out.dispatches),
                  gpu::storage<shared::kTilesBinding>(out.lists), gpu::constants(push));
        const std::uint32_t groups = gpu::Commands::groups(columns * rows, 64);
        c.dispatch(std::min(groups, shared::kTileRow),
                   gpu::Commands::groups(groups, shared::kTileRow), 1);
      });
  return out;
}

void declare_tiles(gpu::PassBuilder& builder, const Tiles& tiles) {
  builder.read(tiles.dispatches, Use::kIndirect);
  builder.read(tiles.dispatches, Use::kComputeRead);
  builder.read(tiles.lists, Use::kComputeRead);
}

void dispatch_tiles(gpu::Commands& commands, const Tiles& tiles, TileKind kind) {
  commands.dispatch_indirect(tiles.dispatches,
                             static_cast<std::uint64_t>(kind) * sizeof(shared::TileDispatch));
}

}  // namespace skerry::render
