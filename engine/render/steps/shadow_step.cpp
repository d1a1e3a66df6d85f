#include "engine/render/steps/shadow_step.h"

#include "engine/render/light/shadow_pass.h"
#include "engine/render/steps/reasons.h"

namespace skerry::render {
namespace {

void draw_shadows(FrameAssembly& f) {
  std::vector<ShadowDraw> redraw;
  std::uint32_t view = 1;
  for (const ActiveCascade& c : f.plan.shadows.cascades) {
    if (!c.redraw) continue;
    redraw.push_back({view, c.layer, shadow_pass_name(c.body, c.index),
                      f.plan.contents.cutouts_in_view[view], c.area});
    ++view;
  }
  f.shadows = ShadowPass::add(f.graph, f.pipelines, f.scene, *f.draws, f.shadow_maps, redraw);
}

}  // namespace

FrameStep draw_shadows_step() {
  return {{{needs_geometry, {"draw_shadow_sun", "draw_shadow_moon"}}}, draw_shadows};
}

}  // namespace skerry::render
