#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

FrameStep bloom_step();

}  // namespace skerry::render
