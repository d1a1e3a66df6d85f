#include "engine/render/steps/reasons.h"

namespace skerry::render {
namespace {

constexpr const char* kNoGeometry = "no geometry is resident";
constexpr const char* kDebugView = "a debug view is shown";

}  // namespace

const char* needs(bool wanted) {
  return wanted ? nullptr : "";
}

ByRadiance everything_if(bool wanted) {
  return wanted ? ByRadiance::kEverything : ByRadiance::kNothing;
}

const char* needs_geometry(const FramePlan& plan) {
  return plan.geometry ? nullptr : kNoGeometry;
}

const char* needs_lit_scene(const FramePlan& plan) {
  return plan.shows_channel() ? kDebugView : nullptr;
}

const char* needs_lit_surfaces(const FramePlan& plan) {
  const char* why = needs_geometry(plan);
  return why ? why : needs_lit_scene(plan);
}

const char* needs_water(const FramePlan& plan) {
  const char* why = needs_lit_surfaces(plan);
  return why ? why : plan.contents.features.why_not(Feature::kWater);
}

const char* needs_glass(const FramePlan& plan) {
  if (const char* why = needs_lit_surfaces(plan)) return why;
  return plan.glass.maps.empty() ? "no glass stands before what sun or moon light" : nullptr;
}

const char* needs_listed_glass(const FramePlan& plan) {
  if (const char* why = needs_glass(plan)) return why;
  if (!plan.glass.stained) return "no glass is stained";
  return needs_water(plan);
}

const char* needs_media_light(const FramePlan& plan) {
  return needs_glass(plan) ? needs_water(plan) : nullptr;
}

const char* needs_clouds(const FramePlan& plan) {
  return needs(plan.clouds && !plan.shows_channel());
}

const char* needs_last_part(const FramePlan& plan) {
  return plan.last_part() ? nullptr : "the picture has parts to come";
}

const char* needs_radiance(const FramePlan& plan) {
  if (const char* why = needs_lit_scene(plan)) return why;
  if (plan.by_radiance != ByRadiance::kEverything) return "shading makes the picture";
  return needs_last_part(plan);
}

}  // namespace skerry::render
