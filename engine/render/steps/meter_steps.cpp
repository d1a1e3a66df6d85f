#include "engine/render/steps/meter_steps.h"

#include "engine/render/frame/frame_choices.h"
#include "engine/render/steps/reasons.h"

namespace skerry::render {
namespace {

const char* needs_meter(const FramePlan& plan) {
  if (const char* why = needs_lit_scene(plan)) return why;
  if (!meters(plan.input, plan.settings)) return "the exposure is given";
  return needs_last_part(plan);
}

}  // namespace

FrameStep meter_step() {
  return {{{needs_meter, {"meter_radiance", "choose_exposure"}}},
          [](FrameAssembly& f) {
            f.metered = MeterPass::add(f.graph, f.pipelines, f.scene,
                                       {f.shaded->radiance(), f.shaded->metered()},
                                       f.plan.settings.meter, !f.plan.input.exposure_ev);
          },
          // An exposure that is given is not waited for.
          [](const FramePlan& plan) {
            return everything_if(
                meters(plan.input, plan.settings) &&
                (!plan.input.exposure_ev || plan.settings.debug_view == DebugView::kExposure));
          }};
}

FrameStep show_exposure_step() {
  return {{{[](const FramePlan& plan) {
            return needs(plan.settings.debug_view == DebugView::kExposure && !needs_meter(plan));
          }}},
          [](FrameAssembly& f) {
            f.developed = MeterPass::show(f.graph, f.pipelines, f.scene, *std::move(f.developed),
                                          f.metered, f.plan.settings.meter);
          }};
}

}  // namespace skerry::render
