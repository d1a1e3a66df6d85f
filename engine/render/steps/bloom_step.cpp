#include "engine/render/steps/bloom_step.h"

#include "engine/render/steps/reasons.h"

namespace skerry::render {
namespace {

const char* needs_bloom(const FramePlan& plan) {
  if (const char* why = needs_lit_scene(plan)) return why;
  if (plan.settings.bloom.intensity <= 0.0f) return "bloom.intensity=0";
  return needs_radiance(plan);
}

}  // namespace

FrameStep bloom_step() {
  return {
      {{needs_bloom, {"shrink_bloom", "spread_bloom"}}},
      [](FrameAssembly& f) {
        f.bloom = BloomPass::add(f.graph, f.pipelines, f.scene, f.shaded->radiance(),
                                 f.plan.settings.bloom);
      },
      [](const FramePlan& plan) { return everything_if(plan.settings.bloom.intensity > 0.0f); }};
}

}  // namespace skerry::render
