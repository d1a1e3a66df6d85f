#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

FrameStep shade_step();

}  // namespace skerry::render
