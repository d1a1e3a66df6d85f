#include "engine/render/steps/cloud_steps.h"

#include "engine/render/sky/cloud_pass.h"
#include "engine/render/steps/reasons.h"

namespace skerry::render {
namespace {

/// Clouds that water mirrors need a sky to be mirrored; an eye in water sees them through it.
const char* needs_mirrored_clouds(const FramePlan& plan) {
  if (const char* why = needs_lit_surfaces(plan)) return why;
  if (const char* why = plan.contents.features.why_not(Feature::kClouds)) return why;
  if (const char* why = plan.contents.features.why_not(Feature::kWater)) return why;
  const bool lit = plan.input.sky.sun_casts || plan.input.sky.moon_casts || plan.indirect ||
                   plan.settings.water_mirror == WaterMirror::kWorld;
  return !lit ? "no sky is mirrored" : nullptr;
}

/// In front of what a pixel shows: that a mirror shows some needs no more than clouds.
bool clouds_are_seen(const FramePlan& plan) {
  return !needs_clouds(plan) && plan.clouds->in_view;
}

CloudPass::View cloud_view(FrameAssembly& f) {
  if (!f.geometry) return {};
  return {&*f.geometry, f.shadows->maps(), f.layers.depth[0], f.lights_or_null()};
}

}  // namespace

FrameStep light_clouds_step() {
  return {{{needs_clouds}}, [](FrameAssembly& f) {
            f.scene.clouds =
                f.owners.clouds.add_light(f.graph, f.pipelines, f.scene, *f.plan.clouds);
          }};
}

FrameStep blend_clouds_behind_water_step() {
  return {
      {{[](const FramePlan& plan) { return needs(clouds_are_seen(plan) && !needs_water(plan)); }}},
      [](FrameAssembly& f) {
        f.shaded = CloudPass::add_behind(f.graph, f.pipelines, f.scene, cloud_view(f),
                                         *std::move(f.shaded), f.plan.settings);
      }};
}

FrameStep mirror_clouds_step() {
  return {{{needs_mirrored_clouds, {"march_mirrored_clouds"}}}, [](FrameAssembly& f) {
            f.layers.mirrored_clouds =
                CloudPass::add_mirrored(f.graph, f.pipelines, f.scene, cloud_view(f), f.layers);
          }};
}

FrameStep blend_clouds_step() {
  return {
      {{[](const FramePlan& plan) {
        return needs(clouds_are_seen(plan) && (!plan.geometry || plan.input.camera_medium == 0));
      }}},
      [](FrameAssembly& f) {
        f.shaded = CloudPass::add(f.graph, f.pipelines, f.scene, cloud_view(f),
                                  *std::move(f.shaded), f.plan.settings);
      },
      [](const FramePlan& plan) { return everything_if(clouds_are_seen(plan)); }};
}

}  // namespace skerry::render
