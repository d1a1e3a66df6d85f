#pragma once
#include "engine/render/frame_contents.h"
#include "engine/render/renderer.h"
#include "engine/render/settings.h"

namespace skerry::render {

/// Whether a debug view takes the place of the lit scene.
bool shows_channel(const RenderSettings& settings);
/// Samples along a pixel's edge. A debug view shows samples as they are.
int samples_per_edge(const RenderSettings& settings);
/// Whether the frame's radiance is metered.
bool meters(const FrameInput& input, const RenderSettings& settings);
/// Whether the picture takes the way over a radiance image though no pass comes between.
bool by_radiance(const FrameInput& input, const RenderSettings& settings,
                 const FrameFeatures& features);
/// Slices of depth in which lights show without a surface: about an eye in water, and in clouds.
std::uint32_t marked_slices(const FrameInput& input, const FrameContents& contents);
/// The sky whose sun and moon stand at the middle of a part's share of their discs: points of a
/// sunflower (H. Vogel, A better way to construct the sunflower head, 1979), which cover it evenly.
Celestial sky_of_part(Celestial sky, std::uint32_t part, std::uint32_t parts);

}  // namespace skerry::render
