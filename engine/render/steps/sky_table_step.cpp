#include "engine/render/steps/sky_table_step.h"

#include "engine/render/sky/sky_pass.h"

namespace skerry::render {

FrameStep sky_table_step() {
  return {
      {{[](const FramePlan& plan) -> const char* {
          if (plan.sky.panorama) return "a panorama is the sky";
          return plan.bake_sky
                     ? nullptr
                     : "sun, moon and the eye's height have not changed since the table was made";
        },
        {"bake_sky"}}},
      [](FrameAssembly& f) { f.scene.sky_lut = add_sky_pass(f.graph, f.pipelines, f.scene); }};
}

}  // namespace skerry::render
