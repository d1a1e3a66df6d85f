#include "engine/render/light/shadow_pass.h"

#include <shader_names.h>
#include <array>

#include "engine/gpu/graph/bindings.h"
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
                        const CulledDraws& draws, gpu::ImageRef maps,
                        std::span<const ShadowDraw> cascades) {
  if (!maps) return Shadows({});
  // Only what faces the light is drawn, so back faces never cast; casters nearer to the light than
  // the map's range are flattened onto it.
  const gpu::GraphicsDesc opaque{.constants = {},
                                 .color_formats = {},
                                 .depth_format = VK_FORMAT_D32_SFLOAT,
                                 .depth_clamp = true};
  const gpu::GraphicsDesc cutout{.constants = {{shared::kTexturedConstant, 1}},
                                 .color_formats = {},
                                 .depth_format = VK_FORMAT_D32_SFLOAT,
                                 .cull = VK_CULL_MODE_NONE,
                                 .depth_clamp = true};
  for (const ShadowDraw& cascade : cascades) {
    using CutoutProgram = gpu::Program<programs::DrawQuadsVert, programs::WriteCutoutDepthFrag>;
    const auto opaque_program = gpu::graphics(pipelines, programs::kDrawQuadsVert, opaque);
    const CutoutProgram cutout_program =
        cascade.cutouts ? gpu::graphics(pipelines, programs::kDrawQuadsVert,
                                        programs::kWriteCutoutDepthFrag, cutout)
                        : CutoutProgram{};
    graph.add_pass(
        cascade.name,
        [&](gpu::PassBuilder& b) {
          declare_draws(b, scene, draws);
          if (cutout_program.pipeline) {
            b.read(scene.materials, Use::kFragmentRead);
            b.read(scene.block_coverage, Use::kFragmentRead);
          }
          maps = b.depth(maps, cascade.clear ? gpu::Load::cleared({}) : gpu::Load::keep(),
                         cascade.layer);
          b.area(cascade.area);
        },
        [scene, draws, view = cascade.view, opaque_program, cutout_program](gpu::Commands& c) {
          gpu::bind(c, opaque_program, draw_bindings(scene, draws, view));
          draw_list(c, scene, draws, view, DrawList::kOpaque);
          if (!cutout_program.pipeline) return;
          gpu::bind(c, cutout_program, draw_bindings(scene, draws, view), cutout_bindings(scene));
          draw_list(c, scene, draws, view, DrawList::kCutout);
        });
  }
  return Shadows(maps);
}

}  // namespace skerry::render
