#include "engine/render/light/light_pass.h"

#include <string>

#include "engine/render/light/light_constants.h"
#include "engine/render/light/wall_reads.h"
#include "engine/render/scene/gbuffer_formats.h"

namespace skerry::render {

using gpu::Use;

Shaded LightPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                      const Geometry& geometry, const ClusteredLights& lights, Shaded shaded,
                      const RenderSettings& settings) {
  const SurfaceReads surfaces(geometry);
  const WallReads walls(scene, settings, scene.corners);
  gpu::ImageRef radiance = shaded.radiance();
  const std::vector<gpu::SpecConstant> constants = lights.with_lights(surfaces.with_store(
      with_light({{0, static_cast<std::uint32_t>(settings.texture_taps)}}, scene, false)));
  const gpu::Pipeline& pipeline =
      pipelines.get(gpu::ComputeDesc{std::string("shade_lights") + surfaces.suffix() + ".comp",
                                     walls.with_walls(with_corners(constants, scene.corners))});
  graph.add_pass(
      "shade_lights",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.islands, scene.materials})
          b.read(ref, Use::kComputeRead);
        declare_tiles(b, lights.tiles);
        lights.declare(b);
        surfaces.declare(b);
        walls.declare(b);
        b.read(scene.block_textures, Use::kComputeSampled);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        radiance = b.write(radiance, Use::kComputeWrite);
      },
      [&pipeline, scene, lights, surfaces, walls, radiance](gpu::Commands& c) {
        c.bind(pipeline);
        c.storage(0, scene.frame);
        c.storage(1, scene.islands);
        c.storage(2, scene.materials);
        c.storage(4, scene.pixel_stats);
        surfaces.bind(c, scene.point_sampler, 5, 6);
        walls.bind(c);
        c.sampled(7, scene.block_textures, scene.block_sampler);
        c.storage(9, radiance);
        lights.bind(c);
        dispatch_tiles(c, lights.tiles, TileKind::kCovered);
      });
  return Shaded(radiance);
}

}  // namespace skerry::render
