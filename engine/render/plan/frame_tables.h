#pragma once
#include <span>
#include <vector>

#include "engine/render/frame/frame_input.h"
#include "engine/render/glass/glass_plan.h"
#include "engine/render/light/shadow_maps.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/geometry.h"

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

/// `to - from`, exact until it becomes a double [blocks].
glm::dvec3 blocks_between(const FixedPos& to, const FixedPos& from);

/// An island relative to a point. The subtraction is exact; only the result becomes float.
shared::IslandTransform transform_of(const IslandPlacement& island, const FixedPos& relative_to);

/// What the camera sees.
shared::CullView cull_view_of(const CameraView& camera);

/// The camera's view comes first, then those of the cascades that are drawn, then those of parts
/// ahead, then those of glass.
FrameTables build_tables(const FrameInput& input, const RenderSettings& settings, VkExtent2D size,
                         std::span<const ActiveCascade> cascades,
                         std::span<const PartAhead> ahead = {}, const GlassPlan& glass = {});

/// The sky whose sun and moon stand at the middle of a part's share of their discs: points of a
/// sunflower (H. Vogel, A better way to construct the sunflower head, 1979), which cover it evenly.
Celestial sky_of_part(Celestial sky, std::uint32_t part, std::uint32_t parts);

/// Whether the sun's or the moon's disc may touch the picture: a cone about the view axis. What has
/// set is swallowed by mist.
bool disc_in_view(const Celestial& sky, const shared::FrameConstants& frame);

/// Planes of a view at `frozen`, for a camera that has since moved to `now`.
void shift_view(shared::CullView& view, const FixedPos& frozen, const FixedPos& now);

}  // namespace skerry::render
