#include "engine/render/geometry_pass.h"

namespace skerry::render {

using gpu::Use;

Geometry GeometryPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                           const SceneRefs& scene, const CulledDraws& draws, bool cutouts) {
  gpu::ImageRef surfaces = graph.create(
      gpu::ImageDesc{.name = "surfaces", .format = VK_FORMAT_R32_UINT, .extent = scene.size});
  gpu::ImageRef depth = graph.create(
      gpu::ImageDesc{.name = "depth", .format = VK_FORMAT_D32_SFLOAT, .extent = scene.size});

  gpu::GraphicsDesc opaque{.vertex = "draw_quads.vert",
                           .fragment = "write_surface.frag",
                           .constants = {},
                           .color_formats = {VK_FORMAT_R32_UINT},
                           .depth_format = VK_FORMAT_D32_SFLOAT};
  gpu::GraphicsDesc cutout{.vertex = "draw_quads.vert",
                           .fragment = "write_cutout.frag",
                           .constants = {{0, 1}},
                           .color_formats = {VK_FORMAT_R32_UINT},
                           .depth_format = VK_FORMAT_D32_SFLOAT,
                           .cull = VK_CULL_MODE_NONE};
  const gpu::Pipeline& opaque_pipeline = pipelines.get(opaque);
  const gpu::Pipeline* cutout_pipeline = cutouts ? &pipelines.get(cutout) : nullptr;

  graph.add_pass(
      "draw_geometry",
      [&](gpu::PassBuilder& b) {
        declare_draws(b, scene, draws);
        if (cutouts) {
          b.read(scene.materials, Use::kFragmentRead);
          b.read(scene.block_textures, Use::kFragmentRead);
        }
        surfaces = b.color(surfaces, gpu::Load::cleared({}));
        depth = b.depth(depth, gpu::Load::cleared({}));
      },
      [scene, draws, &opaque_pipeline, cutout_pipeline](gpu::Commands& c) {
        c.bind(opaque_pipeline);
        draw_list(c, scene, draws, 0, DrawList::kOpaque);
        if (cutout_pipeline) {
          c.bind(*cutout_pipeline);
          c.storage(4, scene.materials);
          c.sampled(5, scene.block_textures, scene.block_sampler);
          draw_list(c, scene, draws, 0, DrawList::kCutout);
        }
      });
  return Geometry(surfaces, depth);
}

}  // namespace skerry::render
