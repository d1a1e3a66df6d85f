#pragma once
#include "engine/render/frame/frame_input.h"
#include "engine/render/frame/settings.h"

namespace skerry::render {

/// Whether a debug view takes the place of the lit scene.
bool shows_channel(const RenderSettings& settings);
/// Samples along a pixel's edge. A debug view shows samples as they are.
int samples_per_edge(const RenderSettings& settings);
/// Pixels of the picture that is drawn where `shown` are shown, 1 an edge at least. A debug view is
/// drawn as large as it is shown.
VkExtent2D picture_size(VkExtent2D shown, const RenderSettings& settings);
/// shadow.blur of this frame: many parts blur edges exactly.
float shadow_blur(const FrameInput& input, const RenderSettings& settings);
/// Null: `aa=temporal` mixes the frame with earlier ones. Else why not.
const char* why_not_temporal(const FrameInput& input, const RenderSettings& settings);
/// Null: the camera's view may be drawn in two phases, so that what is hidden is not drawn. Else
/// why never.
const char* why_never_two_phases(const RenderSettings& settings);
/// Whether the frame's radiance is metered.
bool meters(const FrameInput& input, const RenderSettings& settings);

}  // namespace skerry::render
