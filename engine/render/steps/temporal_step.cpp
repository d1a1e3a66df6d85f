#include "engine/render/steps/temporal_step.h"

#include "engine/render/frame/frame_choices.h"
#include "engine/render/post/temporal_pass.h"
#include "engine/render/steps/reasons.h"

namespace skerry::render {
namespace {

const char* needs_mixing(const FramePlan& plan) {
  if (plan.settings.aa != Antialiasing::kTemporal) return "aa is not temporal";
  if (const char* why = needs_lit_surfaces(plan)) return why;
  return why_not_temporal(plan.input, plan.settings);
}

}  // namespace

FrameStep mix_frames_step() {
  return {
      {{needs_mixing, {"find_mixed_tiles", "mix_planes", "mix_edges"}}}, [](FrameAssembly& f) {
        const bool clouds = f.plan.clouds && f.plan.clouds->in_view;
        f.developed = TemporalPass::add(
            f.graph, f.pipelines, f.scene, *f.geometry, *std::move(f.developed),
            {*f.plan.temporal, f.owners.kept, f.owners.picture.image(), f.layers.depth[0], clouds});
      }};
}

}  // namespace skerry::render
