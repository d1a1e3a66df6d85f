#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

/// `aa=temporal`: the picture is mixed with those of earlier frames.
FrameStep mix_frames_step();

}  // namespace skerry::render
