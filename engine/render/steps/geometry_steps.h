#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

FrameStep cull_step();
FrameStep draw_geometry_step();

}  // namespace skerry::render
