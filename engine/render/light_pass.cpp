#include "engine/render/light_pass.h"

#include <string>

#include "engine/render/gbuffer_formats.h"
#include "engine/render/light_constants.h"
#include "engine/render/occupancy_reads.h"

namespace skerry::render {

using gpu::Use;

namespace {

std::vector<gpu::SpecConstant> with_walls(std::vector<gpu::SpecConstant> own, bool traced,
                                          const RenderSettings& settings) {
  if (!traced) return own;
  own.push_back({40, settings.traced_lights});
  own.push_back({41, static_cast<std::uint32_t>(settings.light_samples)});
  return own;
}

}  // namespace

Shaded LightPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                      const Geometry& geometry, const ClusteredLights& lights, Shaded shaded,
                      const RenderSettings& settings) {
  const SurfaceReads surfaces(geometry);
  const bool traced = settings.traced_lights != 0 && scene.light_islands;
  const OccupancyReads occupancy(scene, scene.corners || traced);
  const gpu::BufferRef light_islands = traced ? scene.light_islands : scene.materials;
  gpu::ImageRef radiance = shaded.radiance();
  const std::vector<gpu::SpecConstant> constants = lights.with_lights(surfaces.with_store(
      with_light({{0, static_cast<std::uint32_t>(settings.texture_taps)}}, scene, false)));
  const gpu::Pipeline& pipeline = pipelines.get(
      gpu::ComputeDesc{std::string("shade_lights") + surfaces.suffix() + ".comp",
                       with_walls(with_corners(constants, scene.corners), traced, settings)});
  graph.add_pass(
      "shade_lights",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.islands, scene.materials})
          b.read(ref, Use::kComputeRead);
        declare_tiles(b, lights.tiles);
        lights.declare(b);
        surfaces.declare(b);
        occupancy.declare(b);
        b.read(light_islands, Use::kComputeRead);
        b.read(scene.block_textures, Use::kComputeSampled);
        scene.pixel_stats = b.write(scene.pixel_stats, Use::kComputeWrite);
        radiance = b.write(radiance, Use::kComputeWrite);
      },
      [&pipeline, scene, lights, surfaces, occupancy, light_islands, radiance](gpu::Commands& c) {
        c.bind(pipeline);
        c.storage(0, scene.frame);
        c.storage(1, scene.islands);
        c.storage(2, scene.materials);
        c.storage(4, scene.pixel_stats);
        surfaces.bind(c, scene.point_sampler, 5, 6);
        occupancy.bind(c);
        c.storage(29, light_islands);
        c.sampled(7, scene.block_textures, scene.block_sampler);
        c.storage(9, radiance);
        lights.bind(c);
        dispatch_tiles(c, lights.tiles, TileKind::kCovered);
      });
  return Shaded(radiance);
}

}  // namespace skerry::render
