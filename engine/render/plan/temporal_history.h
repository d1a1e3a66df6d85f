#pragma once
#include <volk.h>

#include <cstdint>

#include "engine/render/frame/celestial.h"
#include "engine/render/frame/settings.h"

namespace skerry::render {

/// What the last frame has left to mix the next one with (`aa=temporal`).
struct TemporalHistory {
  std::uint64_t generation = 0;        ///< of the images, see KeptFrames
  std::uint64_t geometry_version = 0;  ///< of what they show
  std::uint32_t frames = 0;            ///< that have gone into it
  VkExtent2D drawn{};
  RenderSettings settings;
  Celestial sky{};
  float exposure_ev = 0.0f;
};

}  // namespace skerry::render
