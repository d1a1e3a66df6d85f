#include "engine/render/steps/resolve_step.h"

#include "engine/render/frame/frame_choices.h"
#include "engine/render/post/resolve_pass.h"
#include "engine/render/steps/reasons.h"

namespace skerry::render {
namespace {

const char* needs_samples(const FramePlan& plan) {
  if (const char* why = needs_lit_scene(plan)) return why;
  return samples_per_edge(plan.settings) > 1 ? nullptr : "aa.samples=1";
}

const char* needs_parts(const FramePlan& plan) {
  if (const char* why = needs_lit_scene(plan)) return why;
  return plan.input.parts > 1 ? nullptr : "shadow.samples=1";
}

}  // namespace

FrameStep resolve_step() {
  return {{{needs_samples, {"average_samples"}}, {needs_parts, {"accumulate_part"}}},
          [](FrameAssembly& f) {
            Picture& picture = f.owners.picture;
            f.shaded =
                ResolvePass::add(f.graph, f.pipelines, f.scene, *std::move(f.shaded),
                                 {samples_per_edge(f.plan.settings), picture.image().desc().extent,
                                  f.plan.input.part, f.plan.input.parts, picture.total()});
          },
          [](const FramePlan& plan) {
            return everything_if(samples_per_edge(plan.settings) > 1 || plan.input.parts > 1);
          }};
}

}  // namespace skerry::render
