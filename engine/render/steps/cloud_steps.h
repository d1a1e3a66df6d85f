#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

FrameStep light_clouds_step();
FrameStep blend_clouds_behind_water_step();
FrameStep mirror_clouds_step();
/// Before everything else, unless the eye is in water.
FrameStep blend_clouds_step();

}  // namespace skerry::render
