#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

FrameStep resolve_step();

}  // namespace skerry::render
