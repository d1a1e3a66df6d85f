#include "engine/render/steps/shade_step.h"

#include "engine/render/frame/frame_choices.h"
#include "engine/render/light/shaft_pass.h"
#include "engine/render/steps/reasons.h"
#include "engine/render/surface/shade_pass.h"

namespace skerry::render {
namespace {

/// The frame's lamps, with what is known of the ways to them where each is looked along.
std::optional<ClusteredLights> lamps_of(FrameAssembly& f) {
  if (!f.lights || f.plan.sampled()) return f.lights;
  // Without islands that block lights no walls are looked for. A GPU would wait for each tile's
  // one invocation; and a G-buffer that keeps normals leaves a program no room for them.
  const RenderSettings& settings = f.plan.settings;
  const bool shafts = f.scene.on_cpu && settings.lights_shadows == kEveryLight &&
                      f.scene.light_islands && !settings.lights_oracle && !f.geometry->stored();
  if (!shafts) return f.lights;
  return ShaftPass::add(f.graph, f.pipelines, f.scene, {*f.geometry, settings}, *f.lights);
}

void shade(FrameAssembly& f) {
  const FramePlan& plan = f.plan;
  const FrameFeatures& features = plan.contents.features;
  const std::optional<ClusteredLights> lamps = lamps_of(f);
  const ShadeIn in{plan.settings, features.has(Feature::kStars), features.has(Feature::kDiscs),
                   lamps ? &*lamps : nullptr, plan.sampled()};
  std::optional<ShadedFrom> from;
  if (plan.geometry) from.emplace(ShadedFrom{*f.geometry, *f.shadows, f.layers, f.glass});
  f.shaded = ShadePass::add(f.graph, f.pipelines, f.scene, from ? &*from : nullptr, in,
                            {plan.by_radiance, f.owners.picture.fresh(plan.mixes_at_rest()),
                             meters(plan.input, plan.settings) ? &plan.settings.meter : nullptr});
}

}  // namespace

FrameStep shade_step() {
  return {{{needs_lit_surfaces, {"classify_tiles", "shade_surfaces"}},
           {needs_media_light, {"find_media_light"}},
           {needs_lit_scene, {"shade_sky"}}},
          shade};
}

}  // namespace skerry::render
