#include "engine/render/light/light_pass.h"

#include <shader_names.h>

#include "engine/gpu/graph/bindings.h"
#include "engine/render/light/light_constants.h"
#include "engine/render/light/wall_reads.h"
#include "engine/render/scene/gbuffer_formats.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

using gpu::Use;

Shaded LightPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                      const In& in, Shaded shaded) {
  const ClusteredLights& lights = in.lights;
  const SurfaceReads surfaces(in.geometry);
  const WallReads walls(scene, in.settings, scene.ao);
  gpu::ImageRef radiance = shaded.radiance();
  const std::vector<gpu::SpecConstant> constants = lights.with_panes(surfaces.with_store(with_light(
      {{shared::kTextureTapsConstant, static_cast<std::uint32_t>(in.settings.texture_taps)}}, scene,
      false)));
  const auto program = gpu::compute(pipelines, programs::kShadeLights,
                                    walls.with_walls(with_ao(constants, scene.ao)));
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
      [program, scene, lights, surfaces, walls, radiance](gpu::Commands& c) {
        gpu::bind(
            c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
            gpu::texels<shared::kIslandsBinding>(scene.islands),
            gpu::storage<shared::kMaterialsBinding>(scene.materials),
            gpu::storage<shared::kPixelStatsBinding>(scene.pixel_stats),
            surfaces.bindings(scene.point_sampler), walls.bindings(),
            gpu::sampled<shared::kBlockTexturesBinding>(scene.block_textures, scene.block_sampler),
            gpu::storage<shared::kRadianceBinding>(radiance), lights.bindings(),
            lights.reach_binding(), lights.shaft_binding(),
            lights.tiles.bindings(TileKind::kCovered));
        dispatch_tiles(c, lights.tiles, TileKind::kCovered);
      });
  return Shaded(radiance);
}

}  // namespace skerry::render
