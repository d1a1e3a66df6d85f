#pragma once
#include <volk.h>

#include <cstdint>
#include <vector>

#include "engine/render/frame/celestial.h"
#include "engine/render/frame/settings.h"
#include "engine/render/plan/previous_frame.h"

namespace skerry::render {

/// A frame that is kept.
struct KeptView {
  std::uint64_t geometry_version = 0;  ///< of what it shows
  float exposure_ev = 0.0f;
  PreviousFrame seen;  ///< of the last frame not yet known: FrameHistory has it
};

/// What the last frames have left to mix the next one with (`aa=temporal`).
struct TemporalHistory {
  std::uint64_t generation = 0;  ///< of the images, see KeptFrames
  std::uint32_t frames = 0;      ///< that have gone into it
  VkExtent2D drawn{};
  RenderSettings settings;
  Celestial sky{};
  std::vector<KeptView> views{};  ///< the last frame first; kMixedFrames - 1 at most
};

}  // namespace skerry::render
