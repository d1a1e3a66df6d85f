#include "engine/render/light/shadow_pass.h"

#include <shader_names.h>
#include <array>

#include "engine/render/light/cascades.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

using gpu::Use;

const char* shadow_pass_name(int body, int index) {
  static constexpr std::array<const char*, 8> kNames{
      "draw_shadow_sun_0",  "draw_shadow_sun_1",  "draw_shadow_sun_2",  "draw_shadow_sun_3",
      "draw_shadow_moon_0", "draw_shadow_moon_1", "draw_shadow_moon_2", "draw_shadow_moon_3"};
  return kNames[static_cast<std::size_t>(body * kCascadeCount + index)];
}

Shadows ShadowPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                        const CulledDraws& draws, gpu::Image* maps,
                        std::span<const ShadowDraw> cascades) {
  if (!maps) return Shadows({});
  gpu::ImageRef ref = graph.import(*maps);
  // Only what faces the light is drawn, so back faces never cast; casters nearer to the light than
  // the map's range are flattened onto it.
  const gpu::GraphicsDesc opaque{.vertex = programs::kDrawQuadsVert,
                                 .fragment = "",
                                 .constants = {},
                                 .color_formats = {},
                                 .depth_format = VK_FORMAT_D32_SFLOAT,
                                 .depth_clamp = true};
  const gpu::GraphicsDesc cutout{.vertex = programs::kDrawQuadsVert,
                                 .fragment = programs::kWriteCutoutDepthFrag,
                                 .constants = {{shared::kTexturedConstant, 1}},
                                 .color_formats = {},
                                 .depth_format = VK_FORMAT_D32_SFLOAT,
                                 .cull = VK_CULL_MODE_NONE,
                                 .depth_clamp = true};
  for (const ShadowDraw& cascade : cascades) {
    const gpu::Pipeline& opaque_pipeline = pipelines.get(opaque);
    const gpu::Pipeline* cutout_pipeline = cascade.cutouts ? &pipelines.get(cutout) : nullptr;
    graph.add_pass(
        cascade.name,
        [&](gpu::PassBuilder& b) {
          declare_draws(b, scene, draws);
          if (cutout_pipeline) {
            b.read(scene.materials, Use::kFragmentRead);
            b.read(scene.block_textures, Use::kFragmentRead);
          }
          ref = b.depth(ref, gpu::Load::cleared({}), cascade.layer);
        },
        [scene, draws, view = cascade.view, &opaque_pipeline, cutout_pipeline](gpu::Commands& c) {
          c.bind(opaque_pipeline);
          draw_list(c, scene, draws, view, DrawList::kOpaque);
          if (cutout_pipeline) {
            c.bind(*cutout_pipeline);
            c.storage(shared::kMaterialsBinding, scene.materials);
            c.sampled(shared::kBlockTexturesBinding, scene.block_textures, scene.block_sampler);
            draw_list(c, scene, draws, view, DrawList::kCutout);
          }
        });
  }
  return Shadows(ref);
}

}  // namespace skerry::render
