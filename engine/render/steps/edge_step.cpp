#include "engine/render/steps/edge_step.h"

#include "engine/render/frame/frame_choices.h"
#include "engine/render/post/edge_pass.h"
#include "engine/render/post/temporal_pass.h"
#include "engine/render/steps/reasons.h"

namespace skerry::render {
namespace {

const char* needs_smooth_edges(const FramePlan& plan) {
  if (plan.settings.aa == Antialiasing::kOff) return "aa=off";
  if (const char* why = needs_lit_surfaces(plan)) return why;
  if (samples_per_edge(plan.settings) > 1) return "aa.samples smooths the edges";
  // Planes of surfaces are then known to blocks alone.
  if (plan.settings.gbuffer.depth == DepthStore::kD16) return "gbuffer.depth=d16";
  return needs_last_part(plan);
}

const char* needs_mixing(const FramePlan& plan) {
  if (plan.settings.aa != Antialiasing::kTemporal) return "aa is not temporal";
  if (const char* why = needs_lit_surfaces(plan)) return why;
  return why_not_temporal(plan.input, plan.settings);
}

const char* needs_mixed_edges(const FramePlan& plan) {
  if (const char* why = needs_mixing(plan)) return why;
  return plan.temporal->moves() ? nullptr : "nothing has moved";
}

}  // namespace

FrameStep smooth_edges_step() {
  return {{{needs_smooth_edges, {"find_edge_tiles", "find_edges", "smooth_edges", "store_edges"}}},
          [](FrameAssembly& f) {
            SmoothEdges smooth = EdgePass::add(f.graph, f.pipelines, f.scene, *f.geometry,
                                               *std::move(f.developed), f.plan.tables.constants);
            f.developed = std::move(smooth.picture);
            f.edges = smooth.lists;
          }};
}

FrameStep mix_frames_step() {
  return {
      {{needs_mixing, {"mix_at_rest"}}, {needs_mixed_edges, {"mix_edges"}}}, [](FrameAssembly& f) {
        const bool clouds = f.plan.clouds && f.plan.clouds->in_view;
        f.developed = TemporalPass::add(
            f.graph, f.pipelines, f.scene, *f.geometry, {*std::move(f.developed), *f.edges},
            {*f.plan.temporal, f.owners.kept, f.owners.picture.image(), f.layers.depth[0], clouds});
      }};
}

}  // namespace skerry::render
