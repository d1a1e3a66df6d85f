#include "engine/render/steps/edge_step.h"

#include "engine/render/frame/frame_choices.h"
#include "engine/render/post/edge_pass.h"
#include "engine/render/steps/reasons.h"

namespace skerry::render {
namespace {

const char* needs_smooth_edges(const FramePlan& plan) {
  if (plan.settings.aa != Antialiasing::kEdge) return "aa=off";
  if (const char* why = needs_lit_surfaces(plan)) return why;
  if (samples_per_edge(plan.settings) > 1) return "aa.samples smooths the edges";
  // Planes of surfaces are then known to blocks alone.
  if (plan.settings.gbuffer.depth == DepthStore::kD16) return "gbuffer.depth=d16";
  return needs_last_part(plan);
}

}  // namespace

FrameStep smooth_edges_step() {
  return {{{needs_smooth_edges, {"find_edge_tiles", "find_edges", "smooth_edges", "store_edges"}}},
          [](FrameAssembly& f) {
            f.developed = EdgePass::add(f.graph, f.pipelines, f.scene, *f.geometry,
                                        *std::move(f.developed), f.plan.tables.constants);
          }};
}

}  // namespace skerry::render
