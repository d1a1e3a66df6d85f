#include "engine/render/post/enlarge_pass.h"

#include <shader_names.h>

#include "engine/gpu/device/resources.h"
#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"

namespace skerry::render {

using gpu::Use;

Developed EnlargePass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                           const SceneRefs& scene, Developed developed, VkExtent2D drawn, gpu::Image& shown) {
  const gpu::ImageRef small = developed.picture();
  gpu::ImageRef out = graph.import(shown);
  const VkExtent2D from = drawn, to = shown.desc().extent;
  graph.add_pass(
      "enlarge_picture",
      [&](gpu::PassBuilder& b) {
        b.read(small, Use::kFragmentRead);
        out = b.color(out, gpu::Load::discarded());
      },
      [small, sampler = scene.lut_sampler,
       drawn_from_shown = glm::vec2(from.width, from.height) / glm::vec2(to.width, to.height),
       program = gpu::graphics(pipelines, programs::kCoverPictureVert,
                               programs::kEnlargePictureFrag,
                               {.constants = {},
                                .color_formats = {shown.desc().format},
                                .cull = VK_CULL_MODE_NONE})](gpu::Commands& c) {
        gpu::bind(c, program, gpu::sampled<shared::kSmallPictureBinding>(small, sampler),
                  gpu::constants(drawn_from_shown));
        c.draw(3, 1);
      });
  return Developed(out);
}

}  // namespace skerry::render
