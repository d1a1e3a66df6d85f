#include "engine/render/steps/measure_steps.h"

#include "engine/render/steps/reasons.h"

namespace skerry::render {
namespace {

template <Fault::In in>
bool has_fault(const FramePlan& plan) {
  return plan.input.fault && plan.input.fault->in == in;
}

template <Fault::In in>
const char* needs_fault(const FramePlan& plan) {
  return needs(has_fault<in>(plan) &&
               (in == Fault::In::kSkyTable ? !plan.sky.panorama : !plan.shows_channel()));
}

template <Fault::In in>
ByRadiance breaks(const FramePlan& plan) {
  return everything_if(has_fault<in>(plan));
}

void break_radiance(FrameAssembly& f) {
  f.shaded = FaultPass::add(f.graph, *std::move(f.shaded), *f.plan.input.fault);
}

}  // namespace

FrameStep pixel_stats_step() {
  return {{{[](const FramePlan&) { return needs(true); }}}, [](FrameAssembly& f) {
            f.graph.add_pass(
                "clear_pixel_stats",
                [&](gpu::PassBuilder& b) {
                  f.scene.pixel_stats = b.write(f.scene.pixel_stats, gpu::Use::kTransferWrite);
                },
                [stats = f.scene.pixel_stats](gpu::Commands& c) {
                  c.fill(stats, 0, VK_WHOLE_SIZE, 0);
                });
          }};
}

FrameStep capture_radiance_step() {
  return {
      {{[](const FramePlan& plan) { return needs(plan.input.capture && !needs_radiance(plan)); }}},
      [](FrameAssembly& f) {
        f.owners.captures.add(f.graph, Capture::kRadiance, f.shaded->radiance());
      },
      [](const FramePlan& plan) { return everything_if(plan.input.capture); }};
}

FrameStep capture_geometry_step() {
  return {{{[](const FramePlan& plan) { return needs(plan.input.capture && plan.geometry); }}},
          [](FrameAssembly& f) {
            Captures& captures = f.owners.captures;
            if (f.plan.settings.gbuffer.depth == DepthStore::kD32)
              captures.add(f.graph, Capture::kDepth, f.geometry->depth());
            captures.add(f.graph, Capture::kSurfaces, f.geometry->surfaces());
            if (f.shadows->maps()) captures.add(f.graph, Capture::kShadowMaps, f.shadows->maps());
          }};
}

FrameStep break_sky_table_step() {
  return {{{needs_fault<Fault::In::kSkyTable>}},
          [](FrameAssembly& f) {
            f.scene.sky_lut = FaultPass::add(f.graph, f.scene.sky_lut, *f.plan.input.fault);
          },
          breaks<Fault::In::kSkyTable>};
}

FrameStep break_shaded_step() {
  return {{{needs_fault<Fault::In::kShaded>}}, break_radiance, breaks<Fault::In::kShaded>};
}

FrameStep break_looked_through_step() {
  return {{{needs_fault<Fault::In::kLookedThrough>}},
          break_radiance,
          breaks<Fault::In::kLookedThrough>};
}

}  // namespace skerry::render
