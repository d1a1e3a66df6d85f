#include "engine/render/develop_pass.h"

#include "engine/render/light_constants.h"

namespace skerry::render {

using gpu::Use;

Developed DevelopPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                           Shaded shaded, gpu::Image& picture) {
  gpu::ImageRef out = graph.import(picture);
  const gpu::ImageRef radiance = shaded.radiance();
  graph.add_pass(
      "develop",
      [&](gpu::PassBuilder& b) {
        b.read(scene.frame, Use::kComputeRead);
        b.read(radiance, Use::kComputeRead);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        out = b.write(out, Use::kComputeWrite);
      },
      [scene, radiance, out,
       &pipeline = pipelines.get(gpu::ComputeDesc{"develop.comp", {}})](gpu::Commands& c) {
        c.bind(pipeline);
        c.storage(0, scene.frame);
        c.storage(1, scene.pixel_stats);
        c.storage(2, radiance);
        c.storage(9, out);
        c.dispatch(gpu::Commands::groups(scene.size.width, 8),
                   gpu::Commands::groups(scene.size.height, 8), 1);
      });
  return Developed(out);
}

Developed DevelopPass::add_debug(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                 SceneRefs& scene, const Geometry& geometry, const Shadows& shadows,
                                 DebugView view, gpu::Image& picture) {
  gpu::ImageRef out = graph.import(picture);
  const gpu::ImageRef surfaces = geometry.surfaces(), depth = geometry.depth(),
                      maps = shadows.maps();
  const gpu::Pipeline& pipeline = pipelines.get(
      gpu::ComputeDesc{maps ? "show_channel.comp" : "show_channel_unshadowed.comp",
                       with_light({{0, static_cast<std::uint32_t>(view)}}, scene, bool{maps})});
  graph.add_pass(
      "show_channel",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.islands, scene.materials})
          b.read(ref, Use::kComputeRead);
        b.read(surfaces, Use::kComputeRead);
        b.read(depth, Use::kComputeSampled);
        b.read(scene.block_textures, Use::kComputeSampled);
        if (maps) b.read(maps, Use::kComputeSampled);
        out = b.write(out, Use::kComputeWrite);
      },
      [&pipeline, scene, surfaces, depth, maps, out](gpu::Commands& c) {
        c.bind(pipeline);
        c.storage(0, scene.frame);
        c.storage(1, scene.islands);
        c.storage(2, scene.materials);
        c.storage(3, surfaces);
        c.sampled(4, depth, scene.point_sampler);
        c.sampled(5, scene.block_textures, scene.block_sampler);
        c.storage(6, out);
        if (maps) c.sampled(7, maps, scene.point_sampler);
        c.dispatch(gpu::Commands::groups(scene.size.width, 8),
                   gpu::Commands::groups(scene.size.height, 8), 1);
      });
  return Developed(out);
}

}  // namespace skerry::render
