#pragma once
#include <optional>

#include "engine/render/frame/frame_input.h"
#include "engine/render/light/shadow_plan.h"
#include "engine/render/plan/previous_frame.h"
#include "engine/render/plan/temporal_history.h"
#include "engine/render/sky/cloud_plan.h"
#include "engine/render/sky/sky_model.h"
#include "shaders/shared/geometry.h"

namespace skerry::render {

/// The camera that culling has been frozen with.
struct FrozenView {
  shared::CullView view{};
  FixedPos position{};
};

/// What earlier frames have left behind. plan_frame() reads one and makes the next; it takes effect
/// when the frame has been submitted, so that a frame that fails half-way changes nothing.
struct FrameHistory {
  ShadowHistory shadows;
  std::optional<SkyModel> baked_sky;  ///< that the sky table shows; none: nothing yet
  CloudHistory clouds;
  std::optional<FrozenView> frozen;
  std::optional<TemporalHistory> temporal;  ///< none: the last frame was not kept
  std::optional<PreviousFrame> previous;    ///< none before the first frame
};

}  // namespace skerry::render
