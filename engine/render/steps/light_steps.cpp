#include "engine/render/steps/light_steps.h"

#include "engine/render/light/shaft_pass.h"
#include "engine/render/steps/reasons.h"

namespace skerry::render {
namespace {

void sort_lights(FrameAssembly& f) {
  const ClusterDepths depths{f.geometry->surfaces(), f.geometry->depth(),
                             f.plan.settings.gbuffer.depth == DepthStore::kD16, f.layers.depth,
                             f.layers.count};
  f.lights = f.owners.light_clusters.add(f.graph, f.pipelines, f.scene, depths,
                                         f.plan.settings.lights_oracle);
}

}  // namespace

FrameStep sort_lights_step() {
  return {{{[](const FramePlan& plan) { return needs(plan.lights()); }}}, sort_lights};
}

}  // namespace skerry::render
