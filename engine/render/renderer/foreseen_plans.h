#pragma once
#include <functional>
#include <glm/vec2.hpp>

#include "engine/render/plan/frame_plan.h"

namespace skerry::render {

/// What the programs and the memory of frames depend on that does not change with the view or the
/// time of day.
struct FrameNeeds {
  RenderSettings settings;
  glm::uvec2 drawn{};  ///< pixels
  bool metered = false, given_exposure = false, parts = false, occupancy = false, indirect = false,
       volumes = false;
  std::uint32_t light_kinds =
      0;  ///< of the lights that come with frames, in view or not, and torches
  bool operator==(const FrameNeeds&) const = default;
};
FrameNeeds frame_needs(const FramePlan& plan, const SceneFacts& facts);

/// What a world's first frames are likely to need: their settings and sky are known, and ground
/// with lamps, cut-out blocks and water is supposed to be in view, as it is where players arrive.
/// @param now of a frame without geometry.
FramePlan expected_plan(const FramePlan& now, const FrameNeeds& needs);

/// Calls `visit` with plans of frames to come: the same settings, with each of sun, moon, stars,
/// water around the eye or in view, lights and cut-out blocks there or not. Together they use every
/// program, image and buffer that such frames can need. The plans are good for asking for those
/// alone.
void each_foreseen(const FramePlan& now, const FrameNeeds& needs,
                   const std::function<void(const FramePlan&)>& visit);

}  // namespace skerry::render
