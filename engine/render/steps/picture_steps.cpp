#include "engine/render/steps/picture_steps.h"

#include "engine/render/post/develop_pass.h"
#include "engine/render/post/enlarge_pass.h"
#include "engine/render/steps/reasons.h"
#include "engine/render/surface/marker_pass.h"

namespace skerry::render {
namespace {

void show_channel(FrameAssembly& f) {
  (void)DevelopPass::add_debug(
      f.graph, f.pipelines, f.scene,
      {*f.geometry, *f.shadows, f.lights_or_null(), f.plan.settings.debug_view},
      f.owners.picture.image());
}

const char* needs_picture(const FramePlan& plan) {
  const char* why = needs_lit_scene(plan);
  return why ? why : needs_last_part(plan);
}

const char* needs_enlarging(const FramePlan& plan) {
  if (const char* why = needs_lit_scene(plan)) return why;
  return plan.enlarged() ? needs_last_part(plan) : "render.scale=1";
}

}  // namespace

FrameStep show_channel_step() {
  return {{{[](const FramePlan& plan) { return needs(plan.shows_channel()); }}}, show_channel};
}

FrameStep develop_step() {
  return {{{needs_picture}, {needs_radiance, {"develop"}}}, [](FrameAssembly& f) {
            f.developed = DevelopPass::add(f.graph, f.pipelines, f.scene, *std::move(f.shaded),
                                           f.bloom ? &*f.bloom : nullptr,
                                           f.owners.picture.fresh(f.plan.mixes_at_rest()));
          }};
}

FrameStep draw_marker_step() {
  return {{{[](const FramePlan& plan) { return needs(plan.marker && plan.last_part()); }}},
          [](FrameAssembly& f) {
            f.developed = MarkerPass::add(f.graph, f.pipelines, f.scene, *f.geometry,
                                          *std::move(f.developed), *f.plan.marker);
          }};
}

FrameStep enlarge_step() {
  return {{{needs_enlarging, {"enlarge_picture"}}}, [](FrameAssembly& f) {
            f.developed = EnlargePass::add(f.graph, f.pipelines, f.scene, *std::move(f.developed),
                                           f.owners.picture.shown());
          }};
}

}  // namespace skerry::render
