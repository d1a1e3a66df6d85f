#include "engine/render/surface/tail_pass.h"

#include <shader_names.h>

#include "engine/gpu/graph/bindings.h"
#include "engine/render/scene/tiles.h"
#include "shaders/shared/bindings.h"

namespace skerry::render {
namespace {

using gpu::Use;

constexpr VkFormat kSumFormat = VK_FORMAT_R32G32B32A32_SFLOAT;

void clear(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
           TranslucentPass::Layers& layers) {
  const Tiles tiles = classify_tiles(graph, pipelines, scene, "classify_tail_tiles",
                                     {.words = layers.surfaces,
                                      .depth = layers.depth[layers.count - 1],
                                      .area = scene.layers_area,
                                      .area_alone = true});
  graph.add_pass(
      "clear_tail",
      [&](gpu::PassBuilder& b) {
        declare_tiles(b, tiles);
        b.read(scene.frame, Use::kComputeRead);
        layers.tail_depths = b.write(layers.tail_depths, Use::kComputeWrite);
        layers.tail_light = b.write(layers.tail_light, Use::kComputeWrite);
      },
      [frame = scene.frame, tiles, depths = layers.tail_depths, light = layers.tail_light,
       program = gpu::compute(pipelines, programs::kClearTail)](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(frame),
                  gpu::storage<shared::kTailDepthsBinding>(depths),
                  gpu::storage<shared::kTailLightBinding>(light),
                  tiles.bindings(TileKind::kCovered));
        dispatch_tiles(c, tiles, TileKind::kCovered);
      });
}

}  // namespace

TranslucentPass::Layers TailPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                      const SceneRefs& scene, const CulledDraws& draws,
                                      const Geometry& geometry, TranslucentPass::Layers layers) {
  if (!scene.sums_floats) {
    graph.leave_out("sum_tail", "this device cannot add to images of 32-bit floats");
    return layers;
  }
  layers.tail_depths = graph.create(
      gpu::ImageDesc{.name = "tail depths", .format = kSumFormat, .extent = scene.size});
  layers.tail_light = graph.create(
      gpu::ImageDesc{.name = "tail light", .format = kSumFormat, .extent = scene.size});
  clear(graph, pipelines, scene, layers);
  const glm::uvec4 shown = scene.layers_area;
  const gpu::ImageRef opaque = geometry.depth(), last = layers.depth[layers.count - 1];
  graph.add_pass(
      "sum_tail",
      [&](gpu::PassBuilder& b) {
        declare_draws(b, scene, draws);
        for (const gpu::BufferRef ref : {scene.frame, scene.islands, scene.materials})
          b.read(ref, Use::kFragmentRead);
        for (const gpu::ImageRef ref : {scene.block_textures, opaque, last, layers.surfaces})
          b.read(ref, Use::kFragmentRead);
        b.area({{static_cast<std::int32_t>(shown.x), static_cast<std::int32_t>(shown.y)},
                {shown.z - shown.x, shown.w - shown.y}});
        layers.tail_depths = b.color(layers.tail_depths, gpu::Load::keep());
        layers.tail_light = b.color(layers.tail_light, gpu::Load::keep());
      },
      [scene, draws, opaque, last, words = layers.surfaces,
       program = gpu::graphics(
           pipelines, programs::kDrawQuadsVert, programs::kSumTailFrag,
           gpu::GraphicsDesc{.constants = {{shared::kWaterLayersConstant, layers.count}},
                             .color_formats = {kSumFormat, kSumFormat},
                             .cull = VK_CULL_MODE_NONE,
                             .blend = gpu::Blend::kSum})](gpu::Commands& c) {
        gpu::bind(
            c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
            gpu::texels<shared::kIslandsBinding>(scene.islands),
            gpu::storage<shared::kMaterialsBinding>(scene.materials),
            gpu::sampled<shared::kBlockTexturesBinding>(scene.block_textures, scene.block_sampler),
            gpu::sampled<shared::kDepthsBinding>(opaque, scene.point_sampler),
            gpu::sampled<shared::kPreviousDepthsBinding>(last, scene.point_sampler),
            gpu::sampled<shared::kLayerSurfacesBinding>(words, scene.point_sampler),
            draw_bindings(scene, draws, 0));
        draw_list(c, scene, draws, 0, DrawList::kTranslucent);
      });
  return layers;
}

}  // namespace skerry::render
