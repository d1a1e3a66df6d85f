#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

FrameStep cull_step();
FrameStep draw_geometry_step();
/// Of what the last frame did not show, where that is drawn first.
FrameStep draw_revealed_step();

}  // namespace skerry::render
