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

namespace {

/// Whole tiles and a last part that lie before a pixel.
glm::uvec2 tiles_before(glm::uvec2 pixel) {
  return (pixel + (shared::kTileEdge - 1)) / shared::kTileEdge;
}

}  // namespace

std::uint32_t tile_count(VkExtent2D picture) {
  const glm::uvec2 all = tiles_before({picture.width, picture.height});
  return all.x * all.y;
}

void dispatch_items(gpu::Commands& commands, std::uint32_t items) {
  const std::uint32_t groups = gpu::Commands::groups(items, 64);
  commands.dispatch(std::min(groups, shared::kTileRow),
                    gpu::Commands::groups(groups, shared::kTileRow), 1);
}

void clear_dispatch(gpu::Commands& commands, gpu::BufferRef dispatches, std::uint64_t offset) {
  commands.fill(dispatches, offset + offsetof(shared::TileDispatch, groups_x), 4, 0);
  commands.fill(dispatches, offset + offsetof(shared::TileDispatch, groups_y), 8, 1);
  commands.fill(dispatches, offset + offsetof(shared::TileDispatch, tiles), 4, 0);
}

Tiles create_tiles(gpu::FrameGraph& graph, const std::string& clear_name, std::uint32_t tiles,
                   bool squares) {
  Tiles out;
  constexpr std::uint32_t kAcross = shared::kTileEdge / shared::kSquareEdge;
  const std::uint64_t words = shared::kTileKinds + (squares ? 2 * kAcross * kAcross : 0);
  out.lists = graph.create(gpu::BufferDesc{
      "tile lists",
      shared::kListKinds * sizeof(shared::TileDispatch) + words * tiles * sizeof(std::uint32_t), 0,
      gpu::Memory::kDevice});
  out.squares = squares;
  graph.add_pass(
      clear_name, [&](gpu::PassBuilder& b) { out.lists = b.write(out.lists, Use::kTransferWrite); },
      [lists = out.lists](gpu::Commands& c) {
        for (std::uint64_t kind = 0; kind < shared::kListKinds; ++kind)
          clear_dispatch(c, lists, kind * sizeof(shared::TileDispatch));
      });
  return out;
}

Tiles classify_tiles(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                     const char* name, const Coverage& coverage) {
  const LampReads lamps = coverage.lamps.value_or(LampReads::none(scene));
  const VkExtent2D size = scene.size;
  const glm::uvec2 all = tiles_before({size.width, size.height});
  Tiles out = create_tiles(graph, std::string(name) + "_clear", tile_count(size));
  graph.add_pass(
      name,
      [&](gpu::PassBuilder& b) {
        b.read(coverage.words, Use::kComputeRead);
        b.read(coverage.depth, Use::kComputeSampled);
        lamps.declare(b);
        out.lists = b.write(out.lists, Use::kComputeWrite);
      },
      [coverage, lamps, out, all, size, sampler = scene.point_sampler,
       program = gpu::compute(
           pipelines, programs::kClassifyTiles,
           lamps.with_lamps(coverage.kept == DepthStore::kD16
                                ? std::vector<gpu::SpecConstant>{{shared::kDepth16Constant, 1}}
                                : std::vector<gpu::SpecConstant>{}))](gpu::Commands& c) {
        const glm::uvec2 first =
            coverage.area_alone ? glm::uvec2(coverage.area) / shared::kTileEdge : glm::uvec2(0);
        const glm::uvec2 looked_at =
            coverage.area_alone ? tiles_before({coverage.area.z, coverage.area.w}) - first : all;
        const struct {
          glm::uvec4 area;
          glm::uvec2 size, tile_count, first_tile, looked_at;
        } push{coverage.area, {size.width, size.height}, all, first, looked_at};
        gpu::bind(c, program, gpu::storage<shared::kSurfacesBinding>(coverage.words),
                  gpu::sampled<shared::kDepthsBinding>(coverage.depth, sampler),
                  gpu::storage<shared::kTilesBinding>(out.lists), lamps.bindings(),
                  gpu::constants(push));
        dispatch_items(c, looked_at.x * looked_at.y);
      });
  return out;
}

LampReads LampReads::none(const SceneRefs& scene) {
  return {.grid = scene.frame, .clusters = scene.materials, .depths = scene.materials};
}

std::vector<gpu::SpecConstant> LampReads::with_lamps(std::vector<gpu::SpecConstant> own) const {
  if (lit) own.push_back({shared::kLitConstant, 1});
  if (oracle) own.push_back({shared::kOracleConstant, 1});
  return own;
}

void LampReads::declare(gpu::PassBuilder& builder) const {
  for (const gpu::BufferRef ref : {grid, clusters, depths}) builder.read(ref, Use::kComputeRead);
}

void declare_tiles(gpu::PassBuilder& builder, const Tiles& tiles) {
  builder.read(tiles.lists, Use::kIndirect);
  builder.read(tiles.lists, Use::kComputeRead);
}

void dispatch_tiles(gpu::Commands& commands, const Tiles& tiles, TileKind kind) {
  commands.dispatch_indirect(tiles.lists,
                             static_cast<std::uint64_t>(kind) * sizeof(shared::TileDispatch));
}

}  // namespace skerry::render
