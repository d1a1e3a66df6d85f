#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

FrameStep draw_translucent_step();
/// What glass does to light on its way to surfaces.
FrameStep draw_glass_step();
FrameStep shade_translucent_step();

}  // namespace skerry::render
