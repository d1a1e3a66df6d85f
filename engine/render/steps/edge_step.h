#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

/// `aa=edge`: each pixel at an edge shows both sides of it.
FrameStep smooth_edges_step();
/// `aa=temporal`: the picture is mixed with those of earlier frames.
FrameStep mix_frames_step();

}  // namespace skerry::render
