#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

FrameStep draw_shadows_step();

}  // namespace skerry::render
