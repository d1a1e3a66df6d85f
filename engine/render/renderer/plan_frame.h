#pragma once
#include "engine/render/plan/frame_plan.h"

namespace skerry::render {

/// A picture as it is asked for.
struct PictureRequest {
  const FrameInput& input;
  const RenderSettings& settings;
  VkExtent2D size{};  ///< of the picture that is shown [pixels]
};

/// Decides a frame. A function of its arguments alone: the same request, facts and history give the
/// same plan.
FramePlan plan_frame(const PictureRequest& request, const SceneFacts& facts,
                     const FrameHistory& history);

/// Decides the rest of a plan from what the frame has: `by_radiance`, the steps, and why the others
/// are left out.
void choose_steps(FramePlan& plan);

}  // namespace skerry::render
