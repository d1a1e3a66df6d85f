#include "engine/render/steps/shadow_step.h"

#include "engine/render/light/shadow_pass.h"
#include "engine/render/steps/reasons.h"

namespace skerry::render {
namespace {

void draw_shadows(FrameAssembly& f) {
  std::vector<ShadowDraw> shown, draws;
  std::uint32_t view = 1;
  const std::vector<bool>& cutouts = f.plan.contents.cutouts_in_view;
  for (const ActiveCascade& c : f.plan.shadows.cascades) {
    if (!c.redraw) continue;
    shown.push_back({view, c.layer, shadow_pass_name(c.body, c.index), cutouts[view], c.area});
    ++view;
  }
  const std::uint32_t edge = f.plan.shadows.layout.edge;
  for (const PartAhead& part : f.plan.shadows.ahead) {
    draws.push_back(
        {view, part.layer, "draw_shadow_ahead", cutouts[view], {{0, 0}, {edge, edge}}, part.clear});
    ++view;
  }
  // The last: a map that is ready may be shown in this frame, and more of it be drawn.
  draws.insert(draws.end(), shown.begin(), shown.end());
  f.shadows = ShadowPass::add(f.graph, f.pipelines, f.scene, *f.draws, f.shadow_maps, draws);
}

}  // namespace

FrameStep draw_shadows_step() {
  return {{{needs_geometry, {"draw_shadow_sun", "draw_shadow_moon"}}}, draw_shadows};
}

}  // namespace skerry::render
