#include "engine/render/renderer/foreseen_plans.h"

#include <array>
#include <vector>

#include "engine/render/frame/frame_choices.h"
#include "engine/render/light/light_clusters.h"
#include "engine/render/renderer/plan_frame.h"

namespace skerry::render {
namespace {

enum class Water : std::uint8_t { kNone, kInView, kAroundEye };

/// What changes with the view and the time of day.
struct Supposed {
  std::uint32_t bodies = 0;  // bit a body that gives light
  std::uint32_t lights = 0;  // bit a kind that is in view
  Water water = Water::kNone;
  bool glass = false;  // is, before what the bodies light
  bool stars = false, discs = false;
  bool clouds = true;      // that there are, are in view
  bool cloud_sky = false;  // lights them by itself
  bool blended = false;    // sections that change their level are in view
  bool stained = false;    // some of the glass
};

constexpr std::uint32_t kTorches = 1u << shared::kLightPoint;  // what grows and is built
constexpr const char* kSupposed = "supposed to be absent";
constexpr std::uint32_t kSomeBlock = 1;
constexpr std::uint32_t kSomeIsland[]{0};

std::vector<shared::Light> lights_of(std::uint32_t kinds) {
  std::vector<shared::Light> out;
  for (std::uint32_t kind = 0; kind < shared::kLightKindCount; ++kind) {
    if ((kinds & 1u << kind) == 0) continue;
    out.emplace_back();
    out.back().kind = kind;
    if ((kinds & shared::kLightPanesBit) != 0) out.back().pane_count = 1;
  }
  return out;
}

/// What all supposed frames share.
FramePlan common_of(const FramePlan& now, const FrameNeeds& needs) {
  FramePlan plan = now;
  plan.geometry = true;
  plan.input.capture = false;
  plan.input.fault.reset();
  plan.input.part = plan.input.parts - 1;
  plan.input.light_islands = kSomeIsland;
  if (!plan.temporal && !why_not_temporal(plan.input, plan.settings)) plan.temporal.emplace();
  // One earlier frame is at rest, and one is not.
  if (plan.temporal) plan.temporal->step.kept = 3, plan.temporal->step.still = 1;
  plan.indirect =
      needs.indirect && plan.settings.indirect != Indirect::kOff && !plan.shows_channel();
  plan.ao = needs.occupancy && plan.settings.ao_strength > 0.0f &&
            plan.settings.shading != Shading::kFlat;
  plan.bake_sky = !plan.sky.panorama;
  if (!plan.shows_channel()) plan.marker.emplace();
  if (plan.clouds) plan.clouds->bake_noise = plan.clouds->layer;
  return plan;
}

void suppose_bodies(FramePlan& plan, const FrameNeeds& needs, std::uint32_t bodies) {
  plan.input.sky.sun_casts = (bodies & 1u) != 0;
  plan.input.sky.moon_casts = (bodies & 2u) != 0;
  plan.shadows.cascades.clear();
  plan.shadows.ahead.clear();
  for (std::uint32_t body = 0; body < shared::kBodyCount; ++body) {
    const bool shines = (bodies & 1u << body) != 0;
    plan.tables.constants.bodies[body].irradiance = glm::vec3(shines ? 1.0f : 0.0f);
    plan.shadows.layout.casting[body] = shines && plan.settings.shadow_enabled;
    if (plan.shadows.layout.casting[body])
      plan.shadows.cascades.push_back(
          {static_cast<int>(body), 0, 0, 0, true, {{0, 0}, {1, 1}}, {}, {}});
  }
  plan.shadows.layout.layers = static_cast<std::uint32_t>(plan.shadows.cascades.size());
  plan.shadows.layout.edge = static_cast<std::uint32_t>(plan.settings.shadow_size);
  if (!plan.clouds || !needs.volumes) return;
  plan.clouds->volume_light = bodies != 0 || plan.clouds->sky;
  plan.clouds->light_jobs = {{0, 0}};
}

void suppose(FramePlan& plan, const FrameNeeds& needs, const Supposed& what) {
  if (plan.clouds) {
    plan.clouds->in_view = what.clouds;
    plan.clouds->sky = what.cloud_sky;
  }
  suppose_bodies(plan, needs, what.bodies);
  FrameFeatures features(plan.settings.leave_out);
  const auto absent_unless = [&](bool there, Feature feature) {
    if (!there) features.set_absent(feature, kSupposed);
  };
  absent_unless((what.bodies & 1u) != 0, Feature::kSun);
  absent_unless((what.bodies & 2u) != 0, Feature::kMoon);
  absent_unless(what.bodies != 0 || plan.indirect, Feature::kHaze);
  absent_unless(what.stars, Feature::kStars);
  absent_unless(what.discs, Feature::kDiscs);
  absent_unless(what.water != Water::kNone, Feature::kWater);
  absent_unless(what.lights != 0, Feature::kLights);
  absent_unless(plan.clouds.has_value(), Feature::kClouds);
  plan.input.camera_medium =
      what.water == Water::kAroundEye && features.has(Feature::kWater) ? kSomeBlock : 0;
  plan.glass.edge = 1;
  plan.glass.maps.assign(what.glass && !plan.shadows.cascades.empty() ? 1 : 0, {});
  plan.glass.stained = what.stained;
  for (GlassMap& map : plan.glass.maps) map.area = {{0, 0}, {1, 1}};
  plan.contents = {features, {}, plan.tables.constants.layers_area, {}};
  plan.contents.blended = what.blended;
  plan.contents.cutouts_in_view.assign(1 + plan.shadows.cascades.size(),
                                       features.has(Feature::kCutouts));
  if (features.has(Feature::kLights)) plan.contents.lights = lights_of(what.lights);
  plan.steps.clear();
  plan.left_out.clear();
  choose_steps(plan);
}

}  // namespace

FrameNeeds frame_needs(const FramePlan& plan, const SceneFacts& facts) {
  return {.settings = plan.settings,
          .drawn = {plan.drawn.width, plan.drawn.height},
          .metered = plan.input.meter,
          .given_exposure = plan.input.exposure_ev.has_value(),
          .parts = plan.input.parts > 1,
          .occupancy = facts.occupancy,
          .indirect = facts.indirect,
          .volumes = !facts.clouds.volumes.empty(),
          .light_kinds = light_kinds(plan.input.lights) | kTorches};
}

FramePlan expected_plan(const FramePlan& now, const FrameNeeds& needs) {
  FramePlan plan = common_of(now, needs);
  plan.marker.reset();
  plan.why_one_phase = kSupposed;
  const FrameFeatures& features = now.contents.features;
  Supposed what{.lights = kTorches, .water = Water::kInView};
  what.bodies = (now.input.sky.sun_casts ? 1u : 0u) | (now.input.sky.moon_casts ? 2u : 0u);
  what.stars = features.has(Feature::kStars);
  what.discs = features.has(Feature::kDiscs);
  what.clouds = now.clouds && now.clouds->in_view;
  what.cloud_sky = now.clouds && now.clouds->sky;
  suppose(plan, needs, what);
  return plan;
}

void each_foreseen(const FramePlan& now, const FrameNeeds& needs,
                   const std::function<void(const FramePlan&)>& visit) {
  FramePlan plan = common_of(now, needs);
  if (!why_never_two_phases(plan.settings)) {
    plan.why_one_phase = nullptr;
    suppose(plan, needs, {3u, kTorches, Water::kInView});
    visit(plan);
  }
  plan.why_one_phase = kSupposed;
  // No other program depends on these.
  suppose(plan, needs,
          {.bodies = 3u, .lights = kTorches, .water = Water::kInView, .blended = true});
  visit(plan);
  if (plan.temporal) {
    plan.temporal->step.still = 0;
    visit(plan);
    plan.temporal->step.still = 1;
  }
  std::vector<std::uint32_t> kinds{0, kTorches};
  if (needs.light_kinds != kTorches) kinds.push_back(needs.light_kinds);
  const auto visit_with = [&](Supposed what) {
    for (const bool in_view : {true, false})
      for (const bool sky : {false, true}) {
        if (!plan.clouds && (!in_view || sky)) continue;
        if (sky && plan.settings.indirect == Indirect::kOff) continue;
        what.clouds = in_view;
        what.cloud_sky = sky;
        suppose(plan, needs, what);
        visit(plan);
      }
  };
  // Day before night: both, sun, moon, neither.
  for (const std::uint32_t bodies : {3u, 1u, 2u, 0u}) {
    for (const Water water : {Water::kNone, Water::kInView, Water::kAroundEye})
      for (const std::uint32_t lights : kinds) visit_with({bodies, lights, water});
    // Stars and discs concern the sky alone, which goes to the picture, or for lights to an image
    // of radiance, or for water to both.
    for (const bool stars : {false, true}) {
      if (stars && plan.sky.panorama) continue;
      for (const bool discs : {false, true}) {
        visit_with({bodies, 0, Water::kNone, false, stars, discs});
        visit_with({bodies, 0, Water::kInView, false, stars, discs});
        visit_with({bodies, kTorches, Water::kInView, false, stars, discs});
      }
    }
  }
  // What players build comes last.
  for (const std::uint32_t bodies : {1u, 2u, 3u})
    for (const std::uint32_t lights : kinds) {
      const auto visit_glass = [&](Water water, bool stained) {
        visit_with({.bodies = bodies,
                    .lights = lights,
                    .water = water,
                    .glass = true,
                    .stained = stained});
      };
      visit_glass(Water::kInView, false);
      visit_glass(Water::kInView, true);
      visit_glass(Water::kAroundEye, true);
    }
}

}  // namespace skerry::render
