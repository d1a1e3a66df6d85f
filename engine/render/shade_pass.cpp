#include "engine/render/shade_pass.h"

namespace skerry::render {
namespace {

using gpu::Use;

gpu::ImageRef radiance_image(gpu::FrameGraph& graph, const SceneRefs& scene) {
  return graph.create(gpu::ImageDesc{.name = "radiance", .format = VK_FORMAT_R16G16B16A16_SFLOAT, .extent = scene.size});
}

void dispatch_pixels(gpu::Commands& c, const SceneRefs& scene) {
  c.dispatch(gpu::Commands::groups(scene.size.width, 8), gpu::Commands::groups(scene.size.height, 8), 1);
}

}  // namespace

Shaded ShadePass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene, const Geometry& geometry, const Shadows& shadows,
                      int texture_taps) {
  gpu::ImageRef radiance = radiance_image(graph, scene);
  const gpu::ImageRef surfaces = geometry.surfaces(), depth = geometry.depth(), maps = shadows.maps();
  const gpu::Pipeline& pipeline = pipelines.get(gpu::ComputeDesc{
      maps ? "shade_surfaces.comp" : "shade_surfaces_unshadowed.comp", {{0, static_cast<std::uint32_t>(texture_taps)}}});
  graph.add_pass(
      "shade_surfaces",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.islands, scene.materials, scene.sky}) b.read(ref, Use::kComputeRead);
        b.read(surfaces, Use::kComputeRead);
        for (const gpu::ImageRef ref : {depth, scene.block_textures, scene.sky_lut}) b.read(ref, Use::kComputeSampled);
        if (maps) b.read(maps, Use::kComputeSampled);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        radiance = b.write(radiance, Use::kComputeWrite);
      },
      [&pipeline, scene, surfaces, depth, maps, radiance](gpu::Commands& c) {
        c.bind(pipeline);
        c.storage(0, scene.frame);
        c.storage(1, scene.islands);
        c.storage(2, scene.materials);
        c.storage(3, scene.sky);
        c.storage(4, scene.pixel_stats);
        c.storage(5, surfaces);
        c.sampled(6, depth, scene.point_sampler);
        c.sampled(7, scene.block_textures, scene.block_sampler);
        c.sampled(8, scene.sky_lut, scene.lut_sampler);
        c.storage(9, radiance);
        if (maps) c.sampled(10, maps, scene.point_sampler);
        dispatch_pixels(c, scene);
      });
  return Shaded(radiance);
}

Shaded ShadePass::add_sky_only(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene) {
  gpu::ImageRef radiance = radiance_image(graph, scene);
  const gpu::Pipeline& pipeline = pipelines.get(gpu::ComputeDesc{"shade_sky.comp", {}});
  graph.add_pass(
      "shade_sky",
      [&](gpu::PassBuilder& b) {
        b.read(scene.frame, Use::kComputeRead);
        b.read(scene.sky, Use::kComputeRead);
        b.read(scene.sky_lut, Use::kComputeSampled);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        radiance = b.write(radiance, Use::kComputeWrite);
      },
      [&pipeline, scene, radiance](gpu::Commands& c) {
        c.bind(pipeline);
        c.storage(0, scene.frame);
        c.storage(3, scene.sky);
        c.storage(4, scene.pixel_stats);
        c.sampled(8, scene.sky_lut, scene.lut_sampler);
        c.storage(9, radiance);
        dispatch_pixels(c, scene);
      });
  return Shaded(radiance);
}

}  // namespace skerry::render
