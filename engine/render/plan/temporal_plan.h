#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "engine/render/frame/frame_input.h"
#include "engine/render/frame/settings.h"
#include "engine/render/plan/frame_tables.h"
#include "engine/render/plan/scene_facts.h"
#include "shaders/shared/temporal.h"

namespace skerry::render {

struct FrameHistory;

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

/// How a frame is drawn and mixed with the ones before.
struct TemporalPlan {
  std::uint32_t frame = 0;  ///< since the history began: 0 has none
  glm::vec2 jitter{0.0f};   ///< of the sampled place, from the pixels' centres [pixels]
  std::vector<shared::Motion> motions{};  ///< one an island, and the sky's
  shared::TemporalStep step{};
  TemporalHistory next{};
};

/// Pixels' places sampled by the frames of a history, in turn: the first 16 points of Halton's
/// sequence to the bases 2 and 3, about the pixel's centre, which comes first.
glm::vec2 temporal_jitter(std::uint32_t frame);

/// @param tables before the jitter. @return none: the frame is not mixed with others.
std::optional<TemporalPlan> plan_temporal(const FrameInput& input, const RenderSettings& settings,
                                          const FrameTables& tables, const SceneFacts& facts,
                                          const FrameHistory& history);

/// Moves the camera's view, constants and culling included, by a part of a pixel.
void jitter_view(FrameTables& tables, glm::vec2 jitter);

}  // namespace skerry::render
