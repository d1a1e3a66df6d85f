#include "engine/render/steps/water_steps.h"

#include "engine/render/steps/reasons.h"

namespace skerry::render {

FrameStep draw_translucent_step() {
  return {{{needs_water, {"draw_translucent"}}}, [](FrameAssembly& f) {
            f.layers = TranslucentPass::draw(f.graph, f.pipelines, f.scene,
                                             f.revealed ? *f.revealed : *f.draws, *f.geometry,
                                             f.plan.settings.water_layers);
          }};
}

FrameStep shade_translucent_step() {
  return {{{needs_water, {"classify_translucent_tiles", "shade_translucent"}}},
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
