#include "engine/render/steps/light_steps.h"

#include "engine/render/light/light_pass.h"
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

FrameStep shade_lights_step() {
  // Light at fewer pixels is that of lights as well.
  return {{{[](const FramePlan& plan) {
            return needs(plan.lights() && !plan.shows_channel() && !plan.sampled());
          }}},
          [](FrameAssembly& f) {
            // Without islands that block lights no walls are looked for. A GPU would wait for each
            // tile's one invocation.
            const bool shafts = f.scene.on_cpu && f.plan.settings.lights_shadows == kEveryLight &&
                                f.scene.light_islands && !f.plan.settings.lights_oracle;
            const ClusteredLights lights =
                shafts ? ShaftPass::add(f.graph, f.pipelines, f.scene,
                                        {*f.geometry, f.plan.settings}, *f.lights)
                       : *f.lights;
            f.shaded = LightPass::add(f.graph, f.pipelines, f.scene,
                                      {*f.geometry, lights, f.plan.settings}, *std::move(f.shaded));
          },
          [](const FramePlan& plan) {
            return everything_if(plan.contents.features.has(Feature::kLights) && !plan.sampled());
          }};
}

}  // namespace skerry::render
