// What frames are measured by: numbers, images copied out, and texels broken on purpose.
#pragma once
#include "engine/render/steps/frame_step.h"

namespace skerry::render {

FrameStep pixel_stats_step();
FrameStep capture_radiance_step();
FrameStep capture_geometry_step();
/// See Fault.
FrameStep break_sky_table_step();
FrameStep break_shaded_step();
FrameStep break_looked_through_step();

}  // namespace skerry::render
