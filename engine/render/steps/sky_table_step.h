#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

FrameStep sky_table_step();

}  // namespace skerry::render
