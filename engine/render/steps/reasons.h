// Why passes are left out, for steps that share a reason.
#pragma once
#include "engine/render/plan/frame_plan.h"

namespace skerry::render {

/// Null if passes are wanted; else the reason of passes without names.
const char* needs(bool wanted);
ByRadiance everything_if(bool wanted);
const char* needs_geometry(const FramePlan& plan);
/// No debug view.
const char* needs_lit_scene(const FramePlan& plan);
/// Both.
const char* needs_lit_surfaces(const FramePlan& plan);
const char* needs_water(const FramePlan& plan);
/// Glass that takes light of sun or moon.
const char* needs_glass(const FramePlan& plan);
/// Glass that takes it on its way to water or glass in view.
const char* needs_listed_glass(const FramePlan& plan);
/// One or the other.
const char* needs_media_light(const FramePlan& plan);
const char* needs_clouds(const FramePlan& plan);
/// An image of radiance: what works on it waits for the last part.
const char* needs_radiance(const FramePlan& plan);
/// As soon as the last part is drawn.
const char* needs_last_part(const FramePlan& plan);

}  // namespace skerry::render
