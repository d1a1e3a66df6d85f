#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

FrameStep draw_translucent_step();
FrameStep shade_translucent_step();

}  // namespace skerry::render
