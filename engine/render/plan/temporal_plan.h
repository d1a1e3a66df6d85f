#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "engine/render/frame/frame_input.h"
#include "engine/render/frame/settings.h"
#include "engine/render/plan/frame_tables.h"
#include "engine/render/plan/scene_facts.h"
#include "engine/render/plan/temporal_history.h"
#include "shaders/shared/temporal.h"

namespace skerry::render {

struct FrameHistory;

/// How a frame is drawn and mixed with the ones before.
struct TemporalPlan {
  glm::vec2 jitter{0.0f};  ///< of the sampled place, from the pixels' centres [pixels]
  std::vector<shared::Motion> motions{};  ///< a slot: one an island, and the sky's
  shared::TemporalStep step{};
  TemporalHistory next{};

  /// Whether all pixels are mixed; if not, the rest of the picture is this frame's.
  bool at_rest() const { return step.still != 0; }
  /// Whether anything has moved, come or gone since any of the kept frames.
  bool moves() const {
    return step.kept != step.still || step.changed_area.x < step.changed_area.z;
  }
};

/// Pixels' places sampled at rest by the frames of a history, in turn, from the pixel's centre,
/// which comes first [pixels]. Where something moves all frames sample the centre.
glm::vec2 temporal_jitter(std::uint32_t frame);

/// @param tables before the jitter. @return none: the frame is not mixed with others.
std::optional<TemporalPlan> plan_temporal(const FrameInput& input, const RenderSettings& settings,
                                          const FrameTables& tables, const SceneFacts& facts,
                                          const FrameHistory& history);

/// Moves the camera's view, constants and culling included, by a part of a pixel.
void jitter_view(FrameTables& tables, glm::vec2 jitter);

}  // namespace skerry::render
