#include "engine/render/light/shaft_pass.h"

#include <shader_names.h>

#include <cstdint>

#include "engine/gpu/graph/bindings.h"
#include "engine/render/light/wall_reads.h"
#include "engine/render/scene/gbuffer_formats.h"
#include "engine/render/scene/tiles.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/shafts.h"

namespace skerry::render {

using gpu::Use;

ClusteredLights ShaftPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                               const SceneRefs& scene, const In& in, ClusteredLights lights) {
  const std::uint32_t tiles = tile_count(scene.size);
  const SurfaceReads surfaces(in.geometry);
  const WallReads walls(scene, in.settings, false);
  gpu::BufferRef shafts = graph.create(gpu::BufferDesc{
      "tile shafts", std::uint64_t{tiles} * sizeof(shared::TileShafts), 0, gpu::Memory::kDevice});
  const auto program = gpu::compute(pipelines, programs::kCullShafts,
                                    walls.with_walls(lights.with_lights(surfaces.with_store({}))));
  graph.add_pass(
      "cull_shafts",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, scene.islands, scene.materials})
          b.read(ref, Use::kComputeRead);
        lights.declare(b);
        surfaces.declare(b);
        walls.declare(b);
        shafts = b.write(shafts, Use::kComputeWrite);
      },
      [program, scene, lights, surfaces, walls, shafts, tiles](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::texels<shared::kIslandsBinding>(scene.islands),
                  gpu::storage<shared::kMaterialsBinding>(scene.materials),
                  surfaces.bindings(scene.point_sampler), walls.bindings(), lights.bindings(),
                  gpu::storage<shared::kTileShaftsBinding>(shafts));
        dispatch_items(c, tiles);
      });
  lights.shafts = shafts;
  return lights;
}

}  // namespace skerry::render
