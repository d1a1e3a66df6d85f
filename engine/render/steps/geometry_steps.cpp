#include "engine/render/steps/geometry_steps.h"

#include "engine/render/frame/frame_choices.h"
#include "engine/render/scene/gbuffer_formats.h"
#include "engine/render/scene/geometry_pass.h"
#include "engine/render/steps/reasons.h"

namespace skerry::render {

FrameStep cull_step() {
  return {{{needs_geometry, {"clear_cull_stats", "cull_sections", "cull_scan", "cull_emit"}}},
          [](FrameAssembly& f) {
            const SceneRefs& scene = f.scene;
            f.draws = add_cull_passes(f.graph, f.pipelines, scene,
                                      {scene.section_slots, scene.most_draws,
                                       static_cast<std::uint32_t>(f.plan.tables.views.size())});
          }};
}

FrameStep draw_geometry_step() {
  return {{{needs_geometry, {"draw_geometry"}}}, [](FrameAssembly& f) {
            GeometryPass::Kept kept;
            if (f.plan.temporal) {
              KeptFrames::Frame& now = f.owners.kept.of(f.plan.temporal->frame);
              kept = {f.graph.import(now.surfaces), f.graph.import(now.depth)};
            }
            f.geometry =
                GeometryPass::add(f.graph, f.pipelines, f.scene, *f.draws,
                                  {f.plan.settings.gbuffer, f.plan.contents.cutouts_in_view[0],
                                   samples_per_edge(f.plan.settings) > 1 || f.plan.temporal,
                                   f.plan.input.capture, kept});
          }};
}

}  // namespace skerry::render
