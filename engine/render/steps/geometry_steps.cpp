#include "engine/render/steps/geometry_steps.h"

#include "engine/render/frame/frame_choices.h"
#include "engine/render/scene/gbuffer_formats.h"
#include "engine/render/scene/geometry_pass.h"
#include "engine/render/steps/reasons.h"

namespace skerry::render {
namespace {

CullIn cull_in(const FrameAssembly& f) {
  return {f.scene.section_slots, f.scene.most_draws,
          static_cast<std::uint32_t>(f.plan.tables.views.size()), f.scene.seen_sections};
}

GeometryPass::In geometry_in(FrameAssembly& f) {
  const FrameContents& contents = f.plan.contents;
  // One program of those that leave pixels out, whether or not there are leaves among them.
  const bool cutouts = contents.cutouts_in_view[0] ||
                       (contents.blended && !f.plan.settings.leave_out.has(Feature::kCutouts));
  return {f.plan.settings.gbuffer, cutouts, contents.blended,
          samples_per_edge(f.plan.settings) > 1 || f.plan.temporal, f.plan.input.capture};
}

const char* needs_revealed(const FramePlan& plan) {
  return plan.why_one_phase;
}

}  // namespace

FrameStep cull_step() {
  return {{{needs_geometry, {"clear_cull_stats", "cull_sections", "cull_scan", "cull_emit"}}},
          [](FrameAssembly& f) {
            f.draws = add_cull_passes(f.graph, f.pipelines, f.scene, cull_in(f));
          }};
}

FrameStep draw_geometry_step() {
  return {{{needs_geometry, {"draw_geometry"}}}, [](FrameAssembly& f) {
            f.geometry = GeometryPass::add(f.graph, f.pipelines, f.scene, *f.draws, geometry_in(f));
          }};
}

FrameStep draw_revealed_step() {
  return {{{needs_revealed,
            {"find_far_depths", "cull_hidden", "scan_revealed", "emit_revealed", "draw_revealed"}}},
          [](FrameAssembly& f) {
            f.revealed = add_hidden_passes(f.graph, f.pipelines, f.scene, cull_in(f),
                                           f.geometry->depth(), *f.draws);
            f.draws->stats = f.revealed->stats;
            f.geometry = GeometryPass::add_revealed(f.graph, f.pipelines, f.scene, *f.revealed,
                                                    geometry_in(f), *std::move(f.geometry));
          }};
}

}  // namespace skerry::render
