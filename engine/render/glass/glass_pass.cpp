#include "engine/render/glass/glass_pass.h"

#include <shader_names.h>

#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"

namespace skerry::render {

using gpu::Use;

gpu::ImageRef GlassPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                             const SceneRefs& scene, const CulledDraws& draws,
                             const Shadows& shadows, const GlassPlan& plan,
                             std::uint32_t first_view) {
  if (!scene.sums_floats) {
    graph.leave_out("draw_glass", "this device cannot add to images of 32-bit floats");
    return {};
  }
  constexpr VkFormat kSumFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  gpu::ImageRef maps =
      graph.create(gpu::ImageDesc{.name = "glass maps",
                                  .format = kSumFormat,
                                  .extent = {plan.edge, plan.edge},
                                  .layers = static_cast<std::uint32_t>(plan.maps.size()),
                                  .array = true});
  for (std::uint32_t layer = 0; layer < plan.maps.size(); ++layer) {
    const GlassMap& map = plan.maps[layer];
    struct Push {
      DrawPush draw;
      std::uint32_t cascade;
    };
    graph.add_pass(
        "draw_glass",
        [&](gpu::PassBuilder& b) {
          declare_draws(b, scene, draws);
          for (const gpu::BufferRef ref : {scene.frame, scene.materials})
            b.read(ref, Use::kFragmentRead);
          b.read(shadows.maps(), Use::kFragmentRead);
          b.area(map.area);
          maps = b.color(maps, gpu::Load::cleared({}), layer);
        },
        [scene, draws, shadow_maps = shadows.maps(), view = first_view + layer, slot = map.slot,
         program = gpu::graphics(pipelines, programs::kDrawQuadsVert, programs::kSumGlassFrag,
                                 gpu::GraphicsDesc{.constants = {},
                                                   .color_formats = {kSumFormat},
                                                   .cull = VK_CULL_MODE_NONE,
                                                   .depth_clamp = true,
                                                   .blend = gpu::Blend::kSum})](gpu::Commands& c) {
          gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                    gpu::storage<shared::kMaterialsBinding>(scene.materials),
                    gpu::sampled<shared::kShadowMapsBinding>(shadow_maps, scene.point_sampler),
                    drawn_from(scene, draws),
                    gpu::constants(Push{draw_push(scene, draws, view), slot}));
          draw_list(c, scene, draws, view, DrawList::kTranslucent);
        });
  }
  return maps;
}

}  // namespace skerry::render
