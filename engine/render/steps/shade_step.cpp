#include "engine/render/steps/shade_step.h"

#include "engine/render/frame/frame_choices.h"
#include "engine/render/steps/reasons.h"
#include "engine/render/surface/shade_pass.h"

namespace skerry::render {
namespace {

ShadeIn shade_in(const FramePlan& plan) {
  const FrameFeatures& features = plan.contents.features;
  return {plan.settings.texture_taps, features.has(Feature::kStars), features.has(Feature::kDiscs),
          plan.settings.lights_oracle, std::nullopt};
}

void shade(FrameAssembly& f) {
  ShadeIn in = shade_in(f.plan);
  if (f.plan.sampled())
    in.sampled.emplace(SampledLight{f.lights_or_null(), f.plan.settings,
                                    static_cast<std::uint32_t>(f.plan.settings.shading_rate)});
  std::optional<ShadedFrom> from;
  if (f.plan.geometry) from.emplace(ShadedFrom{*f.geometry, *f.shadows, f.layers, f.glass});
  f.shaded =
      ShadePass::add(f.graph, f.pipelines, f.scene, from ? &*from : nullptr, in,
                     {f.plan.by_radiance, f.owners.picture.fresh(f.plan.mixes_at_rest()),
                      meters(f.plan.input, f.plan.settings) ? &f.plan.settings.meter : nullptr});
}

}  // namespace

FrameStep shade_step() {
  return {{{needs_lit_surfaces, {"classify_tiles", "shade_surfaces"}},
           {needs_media_light, {"find_media_light"}},
           {needs_lit_scene, {"shade_sky"}}},
          shade};
}

}  // namespace skerry::render
