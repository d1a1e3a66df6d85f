#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

FrameStep meter_step();
FrameStep show_exposure_step();

}  // namespace skerry::render
