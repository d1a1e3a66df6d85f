// Steps that write the picture itself.
#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

/// A debug view in place of the lit scene.
FrameStep show_channel_step();
FrameStep develop_step();
FrameStep draw_marker_step();
FrameStep enlarge_step();

}  // namespace skerry::render
