#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

FrameStep draw_translucent_step();
/// What water and glass do to light on its way to surfaces.
FrameStep find_media_light_step();
FrameStep shade_translucent_step();

}  // namespace skerry::render
