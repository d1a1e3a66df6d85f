#pragma once
#include <span>

#include "engine/render/steps/frame_step.h"

namespace skerry::render {

/// All steps, in the order of a frame.
std::span<const FrameStep> frame_steps();

}  // namespace skerry::render
