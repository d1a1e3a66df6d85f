#include "engine/render/steps/water_steps.h"

#include "engine/render/glass/glass_pass.h"
#include "engine/render/steps/reasons.h"
#include "engine/render/surface/layer_light.h"
#include "engine/render/surface/tail_pass.h"

namespace skerry::render {

FrameStep draw_translucent_step() {
  return {{{needs_water, {"draw_translucent", "classify_translucent_tiles", "sum_tail"}}},
          [](FrameAssembly& f) {
            const CulledDraws& draws = f.revealed ? *f.revealed : *f.draws;
            f.layers = TranslucentPass::draw(
                f.graph, f.pipelines, f.scene, draws, *f.geometry,
                {f.plan.settings.water_layers, f.plan.input.camera_medium != 0,
                 !needs_listed_glass(f.plan) && f.shadows->maps()});
            f.layers = TailPass::add(f.graph, f.pipelines, f.scene, draws, *f.geometry, f.layers);
          }};
}

FrameStep draw_glass_step() {
  return {{{needs_glass, {"draw_glass"}}, {needs_listed_glass, {"list_glass", "find_layer_light"}}},
          [](FrameAssembly& f) {
            if (!f.shadows->maps()) return;
            const auto first_view =
                static_cast<std::uint32_t>(f.plan.tables.views.size() - f.plan.glass.maps.size());
            const GlassPass::In in{f.scene, *f.draws, *f.shadows, f.plan.glass, first_view};
            f.glass = GlassPass::add(f.graph, f.pipelines, in);
            if (f.layers.shares)
              f.layers.surfaces =
                  add_layer_light(f.graph, f.pipelines,
                                  {f.scene, *f.shadows, GlassPass::list(f.graph, f.pipelines, in),
                                   f.layers, f.plan.input.camera_medium != 0});
          }};
}

FrameStep shade_translucent_step() {
  return {{{needs_water, {"bend_rays", "shade_translucent"}}},
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
