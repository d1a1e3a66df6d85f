#include "engine/render/renderer/plan_frame.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <utility>

#include "engine/core/check.h"
#include "engine/core/shared_work.h"
#include "engine/render/frame/frame_choices.h"
#include "engine/render/light/shadow_pass.h"
#include "engine/render/plan/in_view.h"
#include "engine/render/renderer/frame_steps.h"
#include "engine/render/sky/sky_irradiance.h"
#include "engine/render/sky/sky_model.h"
#include "engine/render/surface/marker_pass.h"

namespace skerry::render {
namespace {

/// The input as it is drawn: contradictions are settled, and what is left out is gone.
FrameInput drawn_input(const FrameInput& asked, const RenderSettings& settings) {
  FrameInput input = asked;
  input.sky = sky_without(asked.sky, settings.leave_out);
  if (shows_channel(settings)) input.part = 0, input.parts = 1;
  if (input.part + 1 != input.parts) input.capture = false;
  if (settings.leave_out.has(Feature::kWater)) input.camera_medium = 0;
  SKERRY_ASSERT(input.islands.size() <= shared::kMaxIslands);
  return input;
}

/// @return what the camera's sections are culled by, which may be frozen.
shared::CullView plan_culling(FramePlan& plan, const FrameHistory& history) {
  const Camera& camera = plan.input.camera;
  shared::CullView view = cull_view_of(view_of(camera, plan.drawn.width, plan.drawn.height));
  if (!plan.input.freeze_culling) return view;
  plan.next.frozen = history.frozen ? history.frozen : FrozenView{view, camera.position};
  view = plan.next.frozen->view;
  shift_view(view, plan.next.frozen->position, camera.position);
  return view;
}

/// Below so many quads in view the second phase costs more than it spares: docs/decisions/0050.
constexpr std::uint32_t kQuadsForTwoPhases = 65'536;

const char* why_one_phase(const FramePlan& plan, const SceneFacts& facts,
                          const FrameHistory& history) {
  if (!plan.geometry) return "no geometry is resident";
  if (const char* why = why_never_two_phases(plan.settings)) return why;
  if (plan.input.freeze_culling) return "culling is frozen";
  if (plan.settings.occlusion == Occlusion::kAlways) return nullptr;
  if (!history.previous) return "there is no frame before it";
  return facts.quads_in_view < kQuadsForTwoPhases ? "few quads are in view" : nullptr;
}

void plan_sky(FramePlan& plan, const FrameHistory& history) {
  // Other bytes of equal values make the table once more than is needed.
  const auto same_bytes = [](const auto& a, const auto& b) {
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): equal bytes are enough
    return std::memcmp(&a, &b, sizeof(a)) == 0;
  };
  plan.next.baked_sky = history.baked_sky;
  if (plan.sky.panorama) return;
  plan.bake_sky =
      !history.baked_sky || !same_bytes(history.baked_sky->constants, plan.sky.constants);
  plan.next.baked_sky = plan.sky;
  // A table that is broken on purpose is made again by the next frame.
  if (plan.input.fault && plan.input.fault->in == Fault::In::kSkyTable) plan.next.baked_sky.reset();
}

/// The sky lights the air, too: without sun and moon it stays as thick as it was.
void plan_indirect(FramePlan& plan) {
  shared::FrameConstants& frame = plan.tables.constants;
  frame.body_in_air = 1.0f;
  if (!plan.indirect) {
    plan.left_out.push_back({"indirect", plan.settings.indirect == Indirect::kOff
                                             ? "indirect=off"
                                             : "no face is known to see the sky"});
    return;
  }
  frame.body_in_air = air_light(plan.input.sky);
  frame.haze_per_block = kClearAir;
}

void plan_marker(FramePlan& plan) {
  if (!plan.input.marker || !plan.geometry || plan.shows_channel()) return;
  const BlockMarker& marker = *plan.input.marker;
  plan.marker =
      marker_constants(marker, plan.input.islands[marker.island], plan.input.camera, plan.picture);
}

/// Why passes are absent that no step stands for alone: features, and cascades that are kept.
void explain_contents(FramePlan& plan) {
  const FrameFeatures& features = plan.contents.features;
  for (std::size_t i = 0; i < kFeatureNames.size(); ++i)
    if (const char* why = features.why_not(static_cast<Feature>(i)))
      plan.left_out.push_back({std::string(kFeatureNames[i]), why});
  if (!plan.ao)
    plan.left_out.push_back(
        {"ao", plan.settings.shading == Shading::kFlat ? "shading=flat" : "ao.strength=0"});
  if (plan.geometry && !plan.contents.blended)
    plan.left_out.push_back({"blend", "no section in view changes its level of detail"});
  if (plan.clouds && !plan.clouds->in_view)
    for (const char* pass : {"march_clouds", "blend_clouds"})
      plan.left_out.push_back({pass, "no cloud is in view"});
  for (const ActiveCascade& cascade : plan.shadows.cascades)
    if (!cascade.redraw)
      plan.left_out.push_back(
          {shadow_pass_name(cascade.body, cascade.index),
           "kept from an earlier frame: what it shows has not moved, or not far"});
  if (!plan.geometry) return;
  for (const Feature body : {Feature::kSun, Feature::kMoon}) {
    const char* why = features.why_not(body);
    if (!why && !plan.settings.shadow_enabled) why = "shadow.enabled=0";
    if (why)
      plan.left_out.push_back(
          {body == Feature::kSun ? "draw_shadow_sun" : "draw_shadow_moon", why});
  }
}

}  // namespace

namespace {

/// Water and glass mirror what stands above them in the picture.
glm::uvec4 mirrored_area(const FramePlan& plan) {
  const glm::uvec4 layers = plan.contents.layers_area;
  if (plan.settings.water_mirror != WaterMirror::kWorld) return layers;
  return {0, 0, plan.drawn.width, layers.w};
}

glm::uvec4 radiance_area(const FramePlan& plan) {
  switch (plan.by_radiance) {
    case ByRadiance::kNothing:
      return {0, 0, 0, 0};
    case ByRadiance::kLayers:
      return mirrored_area(plan);
    case ByRadiance::kEverything:
      return {0, 0, plan.drawn.width, plan.drawn.height};
  }
  return {};
}

}  // namespace

void choose_steps(FramePlan& plan) {
  const std::span<const FrameStep> all = frame_steps();
  plan.by_radiance = plan.shows_channel() ? ByRadiance::kEverything : ByRadiance::kNothing;
  for (const FrameStep& step : all)
    if (step.by_radiance) plan.by_radiance = std::max(plan.by_radiance, step.by_radiance(plan));
  plan.tables.constants.radiance_area = radiance_area(plan);
  for (std::size_t i = 0; i < all.size(); ++i) {
    bool needed = false;
    for (const StepPasses& passes : all[i].passes) {
      const char* why = passes.why_not(plan);
      needed |= !why;
      if (!why) continue;
      for (const std::string_view name : passes.names)
        plan.left_out.push_back({std::string(name), why});
    }
    if (needed) plan.steps.push_back(i);
  }
}

// The skies of islands depend on little and take long: helpers may work them out meanwhile.
FramePlan plan_frame(const PictureRequest& request, const SceneFacts& facts,
                     const FrameHistory& history) {
  const RenderSettings& settings = request.settings;
  FramePlan plan{.input = drawn_input(request.input, settings),
                 .settings = settings,
                 .shown = request.size,
                 .picture = picture_size(request.size, settings),
                 .contents = {FrameFeatures(settings.leave_out), {}, {}, {}}};
  const auto samples = static_cast<std::uint32_t>(samples_per_edge(settings));
  plan.drawn = {plan.picture.width * samples, plan.picture.height * samples};
  plan.geometry = facts.has_geometry();
  plan.indirect = settings.indirect != Indirect::kOff && facts.indirect && plan.geometry &&
                  !shows_channel(settings);
  plan.sky = sky_model(plan.input.sky, eye_height_km(plan.input),
                       history.baked_sky ? &*history.baked_sky : nullptr, facts.panorama);
  plan.input.sky = sky_of_part(plan.input.sky, plan.input.part, plan.input.parts);
  const shared::CullView culled_by = plan_culling(plan, history);
  SharedWork skies(Helpers::of_frames(), plan.indirect ? 1 : 0, [&](int) {
    const FrameInput& input = plan.input;
    plan.sky_light =
        sky_irradiance(plan.sky, input.sky, input.islands,
                       islands_in_view(facts, input.islands, culled_by, input.camera.position),
                       input.camera.position);
  });
  if (plan.geometry)
    plan.shadows = plan_shadows(plan.input, settings, facts.sections, *facts.changes,
                                history.shadows, facts.shadow_generation);
  if (plan.geometry && facts.glass_boxes)
    plan.glass =
        plan_glass(plan.input, settings, plan.shadows.cascades, facts.sections, *facts.glass_boxes);
  plan.tables = build_tables(plan.input, settings, plan.drawn, plan.shadows.cascades,
                             plan.shadows.ahead, plan.glass);
  if (plan.sky.panorama)
    plan.tables.constants.sky_yaw = static_cast<float>(plan.sky.panorama->yaw());
  plan.tables.constants.picture_size = {plan.picture.width, plan.picture.height};
  plan.contents = contents_of(plan.input, settings, plan.tables, plan.sky.constants, facts);
  plan.tables.constants.layers_area = plan.contents.layers_area;
  plan.ao = facts.occupancy && settings.ao_strength > 0.0f && settings.shading != Shading::kFlat;
  plan.marked_slices = marked_slices(plan.input, plan.contents);
  if (plan.geometry)
    plan.next.shadows = std::move(plan.shadows.next);
  else
    plan.next.shadows = history.shadows;
  plan.next.clouds = history.clouds;
  if (plan.contents.features.has(Feature::kClouds)) {
    plan.clouds = plan_clouds(plan.input, settings.clouds, plan.sky,
                              settings.indirect != Indirect::kOff, facts.clouds, history.clouds);
    plan.clouds->in_view = clouds_in_view(plan.clouds->constants, plan.clouds->layer,
                                          facts.clouds.volumes.size(), plan.tables.constants);
    plan.next.clouds = plan.clouds->next;
  }
  plan.tables.views[0] = culled_by;
  plan.why_one_phase = why_one_phase(plan, facts, history);
  plan_sky(plan, history);
  plan_indirect(plan);
  plan_marker(plan);
  plan.temporal = plan_temporal(plan.input, settings, plan.tables, facts, history);
  if (plan.temporal) {
    plan.next.temporal = plan.temporal->next;
    jitter_view(plan.tables, plan.temporal->jitter);
  }
  plan.next.previous =
      PreviousFrame{plan.input.camera, plan.input.anchor,
                    plan.geometry ? plan.next.shadows.islands : shared_islands(plan.input)};
  explain_contents(plan);
  choose_steps(plan);
  skies.join();
  return plan;
}

}  // namespace skerry::render
