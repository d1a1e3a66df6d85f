#include "engine/render/post/enlarge_pass.h"

#include <shader_names.h>

#include "engine/gpu/device/resources.h"
#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"

namespace skerry::render {

using gpu::Use;

Developed EnlargePass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                           const SceneRefs& scene, Developed developed, gpu::Image& shown) {
  const gpu::ImageRef small = developed.picture();
  gpu::ImageRef out = graph.import(shown);
  graph.add_pass(
      "enlarge_picture",
      [&](gpu::PassBuilder& b) {
        b.read(small, Use::kComputeSampled);
        out = b.write(out, Use::kComputeWrite);
      },
      [small, out, sampler = scene.lut_sampler, size = shown.desc().extent,
       program = gpu::compute(pipelines, programs::kEnlargePicture)](gpu::Commands& c) {
        gpu::bind(c, program, gpu::sampled<shared::kSmallPictureBinding>(small, sampler),
                  gpu::storage<shared::kPictureBinding>(out));
        c.dispatch(gpu::Commands::groups(size.width, 8), gpu::Commands::groups(size.height, 8), 1);
      });
  return Developed(out);
}

}  // namespace skerry::render
