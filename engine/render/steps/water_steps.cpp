#include "engine/render/steps/water_steps.h"

#include "engine/render/steps/reasons.h"
#include "engine/render/surface/tail_pass.h"

namespace skerry::render {

FrameStep draw_translucent_step() {
  return {{{needs_water, {"draw_translucent", "sum_tail"}}}, [](FrameAssembly& f) {
            const CulledDraws& draws = f.revealed ? *f.revealed : *f.draws;
            f.layers = TranslucentPass::draw(f.graph, f.pipelines, f.scene, draws, *f.geometry,
                                             f.plan.settings.water_layers);
            f.layers = TailPass::add(f.graph, f.pipelines, f.scene, draws, *f.geometry, f.layers);
          }};
}

FrameStep shade_translucent_step() {
  return {{{needs_water, {"classify_translucent_tiles", "bend_rays", "shade_translucent"}}},
          [](FrameAssembly& f) {
            f.shaded = TranslucentPass::add(f.graph, f.pipelines, f.scene,
                                            {*f.geometry, *f.shadows, f.layers, f.lights_or_null(),
                                             f.plan.settings, f.plan.input.camera_medium != 0},
                                            *std::move(f.shaded));
          },
          [](const FramePlan& plan) {
            return plan.geometry && plan.contents.features.has(Feature::kWater)
                       ? ByRadiance::kLayers
                       : ByRadiance::kNothing;
          }};
}

}  // namespace skerry::render
