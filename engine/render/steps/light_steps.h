#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

FrameStep sort_lights_step();

}  // namespace skerry::render
