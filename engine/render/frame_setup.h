#pragma once
#include <span>
#include <vector>

#include "engine/render/renderer.h"
#include "engine/render/shadow_maps.h"

namespace skerry::render {

/// The per-frame tables as they are uploaded; view 0 is the camera, then one for each cascade drawn
/// afresh.
struct FrameTables {
  shared::FrameConstants constants{};
  std::vector<shared::CullView> views;
  std::vector<glm::mat4> matrices;  ///< clip_from_source, one a view
  /// How much quads grow in their plane to cover T-junctions, one a view: 1/128 pixel, in blocks a
  /// block of distance along the view axis; of an orthographic view in blocks.
  std::vector<float> edge_growth;
  std::vector<shared::IslandTransform>
      islands;  ///< [view][island], each view's relative to its own source
};

/// An island relative to a point. The subtraction is exact; only the result becomes float.
shared::IslandTransform transform_of(const IslandPlacement& island, const FixedPos& relative_to);

FrameTables build_tables(const FrameInput& input, const RenderSettings& settings, VkExtent2D size,
                         std::span<const ActiveCascade> cascades);

/// How much of the light that air and clouds take from the sky there is, 0..1: taken back as the
/// brighter body sets, so that nothing ends in a step when it is gone.
float air_light(const Celestial& sky);

/// Whether the sun's or the moon's disc may touch the picture: a cone about the view axis. What has
/// set is swallowed by mist.
bool disc_in_view(const Celestial& sky, const shared::FrameConstants& frame);

/// Planes of a view at `frozen`, for a camera that has since moved to `now`.
void shift_view(shared::CullView& view, const FixedPos& frozen, const FixedPos& now);

/// Whether any section with quads of ranges [first, end) touches a view's frustum.
/// @param islands relative to the camera.
bool ranges_in_view(std::span<const shared::Section> sections,
                    std::span<const shared::IslandTransform> islands, const shared::CullView& view,
                    std::uint32_t first, std::uint32_t end);

}  // namespace skerry::render
