#include "engine/render/steps/shade_step.h"

#include "engine/render/steps/reasons.h"
#include "engine/render/surface/shade_pass.h"

namespace skerry::render {
namespace {

ShadeIn shade_in(const FramePlan& plan) {
  const FrameFeatures& features = plan.contents.features;
  return {plan.settings.texture_taps, features.has(Feature::kStars), features.has(Feature::kDiscs),
          std::nullopt};
}

void shade(FrameAssembly& f) {
  ShadeIn in = shade_in(f.plan);
  if (f.plan.sampled())
    in.sampled.emplace(SampledLight{f.lights_or_null(), f.plan.settings,
                                    static_cast<std::uint32_t>(f.plan.settings.shading_rate)});
  gpu::Image& picture = f.owners.picture.image();
  if (f.plan.geometry && f.plan.direct)
    f.developed = ShadePass::add_to_picture(f.graph, f.pipelines, f.scene,
                                            {*f.geometry, *f.shadows}, in, picture);
  else if (f.plan.geometry)
    f.shaded = ShadePass::add(f.graph, f.pipelines, f.scene, {*f.geometry, *f.shadows}, in);
  else if (f.plan.direct)
    f.developed = ShadePass::add_sky_only_to_picture(f.graph, f.pipelines, f.scene, in, picture);
  else
    f.shaded = ShadePass::add_sky_only(f.graph, f.pipelines, f.scene, in);
}

}  // namespace

FrameStep shade_step() {
  return {{{needs_lit_surfaces, {"classify_tiles", "shade_surfaces"}},
           {needs_lit_scene, {"shade_sky"}}},
          shade,
          [](const FramePlan& plan) { return plan.sampled(); }};
}

}  // namespace skerry::render
