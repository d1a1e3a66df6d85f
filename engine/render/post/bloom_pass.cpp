#include "engine/render/post/bloom_pass.h"

#include <shader_names.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "engine/render/post/radiance_filter.h"
#include "engine/render/scene/tiles.h"

namespace skerry::render {
namespace {

using gpu::Use;

VkExtent2D halved(VkExtent2D size) {
  return {(size.width + 1) / 2, (size.height + 1) / 2};
}

/// A step of the pyramid.
struct Level {
  shared::BloomStep step;
  std::uint32_t index = 0;  // of the level that is made
  gpu::ImageRef& no_total;
};

/// Tiles of 8x8 texels of the first level that look at anything too bright.
struct BrightTiles {
  gpu::BufferRef dispatch;  ///< shared::TileDispatch, of eight tiles a work group
  gpu::BufferRef list;      ///< x | y << 16
};

shared::BloomStep step_between(VkExtent2D fine, VkExtent2D coarse, const BloomSettings& settings) {
  return {{fine.width, fine.height},
          {coarse.width, coarse.height},
          settings.threshold,
          settings.intensity};
}

void dispatch_over(gpu::Commands& c, glm::uvec2 size) {
  c.dispatch(gpu::Commands::groups(size.x, 8), gpu::Commands::groups(size.y, 8), 1);
}

/// @param first level of the pyramid, which becomes black.
BrightTiles find_bright_tiles(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                              const SceneRefs& scene, gpu::ImageRef radiance, gpu::ImageRef& first,
                              const shared::BloomStep& step) {
  const std::uint32_t count =
      gpu::Commands::groups(step.coarse_size.x, 8) * gpu::Commands::groups(step.coarse_size.y, 8);
  BrightTiles out{graph.create(gpu::BufferDesc{"bright tile dispatch", sizeof(shared::TileDispatch),
                                               0, gpu::Memory::kDevice}),
                  graph.create(gpu::BufferDesc{"bright tiles", count * sizeof(std::uint32_t), 0,
                                               gpu::Memory::kDevice})};
  graph.add_pass(
      "find_bright_tiles_clear",
      [&](gpu::PassBuilder& b) {
        out.dispatch = b.write(out.dispatch, Use::kTransferWrite);
        first = b.write(first, Use::kTransferWrite);
      },
      [dispatch = out.dispatch, first](gpu::Commands& c) {
        clear_dispatch(c, dispatch, 0);
        c.clear(first, {});
      });
  graph.add_pass(
      "find_bright_tiles",
      [&](gpu::PassBuilder& b) {
        b.read(radiance, Use::kComputeRead);
        b.read(scene.exposure, Use::kComputeRead);
        out.dispatch = b.write(out.dispatch, Use::kComputeWrite);
        out.list = b.write(out.list, Use::kComputeWrite);
      },
      [radiance, exposure = scene.exposure, out, step, count,
       program = gpu::compute(pipelines, programs::kFindBrightTiles, {})](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFineBloomBinding>(radiance),
                  gpu::storage<shared::kExposureBinding>(exposure),
                  gpu::storage<shared::kTileDispatchesBinding>(out.dispatch),
                  gpu::storage<shared::kTilesBinding>(out.list), gpu::constants(step));
        dispatch_items(c, count);
      });
  return out;
}

/// @return the coarser level.
gpu::ImageRef shrink(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                     gpu::ImageRef fine, const Level& level) {
  const shared::BloomStep& step = level.step;
  gpu::ImageRef coarse =
      graph.create(gpu::ImageDesc{.name = "bloom " + std::to_string(level.index),
                                  .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                  .extent = {step.coarse_size.x, step.coarse_size.y}});
  std::optional<BrightTiles> bright;
  if (scene.on_cpu && level.index == 1)
    bright = find_bright_tiles(graph, pipelines, scene, fine, coarse, step);
  RadianceFilter filter{fine, fine, coarse, level.no_total, scene.exposure};
  filter.push.step = step;
  if (bright) {
    filter.dispatches = bright->dispatch;
    filter.tiles = bright->list;
  }
  graph.add_pass(
      "shrink_bloom_" + std::to_string(level.index),
      [&](gpu::PassBuilder& b) {
        b.read(fine, Use::kComputeRead);
        b.read(scene.exposure, Use::kComputeRead);
        coarse = b.write(coarse, Use::kComputeWrite);
        level.no_total =
            b.write(level.no_total, Use::kComputeWrite);  // by the shader's other steps
        if (!bright) return;
        b.read(bright->dispatch, Use::kIndirect);
        b.read(bright->dispatch, Use::kComputeRead);
        b.read(bright->list, Use::kComputeRead);
      },
      [filter, listed = bright.has_value(), columns = scene.on_cpu,
       program = RadianceFilter::program(pipelines, shared::kFilterShrink,
                                         {{shared::kFirstConstant, level.index == 1 ? 1u : 0u},
                                          {shared::kColumnsConstant, scene.on_cpu ? 1u : 0u},
                                          {shared::kListedConstant, bright ? 1u : 0u}})](
          gpu::Commands& c) {
        gpu::bind(c, program, filter.bindings());
        const glm::uvec2 size = filter.push.step.coarse_size;
        if (listed)
          c.dispatch_indirect(filter.dispatches, 0);
        else if (columns)
          c.dispatch(gpu::Commands::groups(size.x, 64), gpu::Commands::groups(size.y, 8), 1);
        else
          dispatch_over(c, size);
      });
  return coarse;
}

/// @return the finer level, with the coarser ones in it.
gpu::ImageRef spread(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                     gpu::ImageRef fine, gpu::ImageRef coarse, const Level& level) {
  RadianceFilter filter{fine, coarse, fine, level.no_total, scene.exposure};
  filter.push.step = level.step;
  graph.add_pass(
      "spread_bloom_" + std::to_string(level.index),
      [&](gpu::PassBuilder& b) {
        b.read(coarse, Use::kComputeRead);
        b.read(scene.exposure, Use::kComputeRead);
        fine = b.write(fine, Use::kComputeWrite);
        level.no_total =
            b.write(level.no_total, Use::kComputeWrite);  // by the shader's other steps
      },
      [filter, columns = scene.on_cpu,
       program = RadianceFilter::program(pipelines, shared::kFilterSpread,
                                         {{shared::kColumnsConstant, scene.on_cpu ? 1u : 0u}})](
          gpu::Commands& c) {
        gpu::bind(c, program, filter.bindings());
        if (columns)
          dispatch_spread_columns(c, filter.push.step.fine_size);
        else
          dispatch_over(c, filter.push.step.fine_size);
      });
  return fine;
}

}  // namespace

void dispatch_spread_columns(gpu::Commands& commands, glm::uvec2 fine_size) {
  commands.dispatch(gpu::Commands::groups(fine_size.x, 64),
                    gpu::Commands::groups(fine_size.y, 2 * shared::kSpreadRows), 1);
}

std::uint32_t bloom_levels(VkExtent2D size, int asked) {
  std::uint32_t levels = 1;
  for (VkExtent2D s = halved(size);
       levels < static_cast<std::uint32_t>(asked) && (s.width > 1 || s.height > 1); s = halved(s))
    ++levels;
  return levels;
}

Bloom BloomPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                     gpu::ImageRef radiance, const BloomSettings& settings) {
  const std::uint32_t levels = bloom_levels(scene.size, settings.levels);
  gpu::ImageRef no_total = RadianceFilter::no_total(graph);
  std::vector<gpu::ImageRef> images{radiance};
  std::vector<shared::BloomStep> steps;
  VkExtent2D size = scene.size;
  for (std::uint32_t level = 1; level <= levels; ++level) {
    steps.push_back(step_between(size, halved(size), settings));
    images.push_back(
        shrink(graph, pipelines, scene, images.back(), {steps.back(), level, no_total}));
    size = halved(size);
  }
  for (std::uint32_t level = levels - 1; level >= 1; --level)
    images[level] = spread(graph, pipelines, scene, images[level], images[level + 1],
                           {steps[level], level, no_total});
  return {images[1], steps[0]};
}

}  // namespace skerry::render
