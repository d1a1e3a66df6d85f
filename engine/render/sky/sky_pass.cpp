#include "engine/render/sky/sky_pass.h"

#include <shader_names.h>

#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/sky.h"

namespace skerry::render {

gpu::ImageRef add_sky_pass(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                           const SceneRefs& scene) {
  gpu::ImageRef table = scene.sky_lut;
  graph.add_pass(
      "bake_sky",
      [&](gpu::PassBuilder& b) {
        b.read(scene.sky, gpu::Use::kComputeRead);
        b.read(scene.sky_scattering, gpu::Use::kComputeRead);
        table = b.write(table, gpu::Use::kComputeWrite);
      },
      [sky = scene.sky, scattering = scene.sky_scattering, table,
       program = gpu::compute(pipelines, programs::kBakeSky)](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kSkyBinding>(sky),
                  gpu::storage<shared::kSkyScatteringBinding>(scattering),
                  gpu::storage<shared::kSkyTableBinding>(table));
        c.dispatch(gpu::Commands::groups(shared::kSkyLutWidth, shared::kSkyLutGroup),
                   gpu::Commands::groups(shared::kSkyLutHeight, shared::kSkyLutGroup), 1);
      });
  return table;
}

}  // namespace skerry::render
