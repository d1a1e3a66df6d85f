#pragma once
#include <optional>
#include <vector>

#include "engine/gpu/graph/frame_graph.h"
#include "engine/render/frame/frame_input.h"
#include "engine/render/frame/phases.h"
#include "engine/render/frame/settings.h"
#include "engine/render/glass/glass_plan.h"
#include "engine/render/light/shadow_plan.h"
#include "engine/render/plan/frame_contents.h"
#include "engine/render/plan/frame_history.h"
#include "engine/render/plan/frame_tables.h"
#include "engine/render/plan/scene_facts.h"
#include "engine/render/plan/temporal_plan.h"
#include "engine/render/sky/cloud_plan.h"
#include "engine/render/sky/sky_model.h"
#include "shaders/shared/marker.h"

namespace skerry::render {

/// One frame, decided: what is drawn, in which steps, and what it will leave behind. Plain values;
/// nothing has been made or recorded. Spans of `input` and of the facts must outlive it.
struct FramePlan {
  FrameInput input;               ///< as drawn: without what is left out, with the sky of its part
  RenderSettings settings;        ///< as asked
  VkExtent2D shown{};             ///< size of the picture that was asked for [pixels]
  VkExtent2D picture{}, drawn{};  ///< `picture` is enlarged to `shown`; `drawn` has aa.samples
                                  ///< times as many pixels
  bool geometry = false;          ///< sections are resident
  SkyModel sky{};                 ///< of the whole picture, not of its part
  /// Null: the camera's view is drawn in two phases, so that what is hidden is not drawn.
  const char* why_one_phase = "no geometry is resident";
  bool bake_sky = false;                ///< else the sky table of an earlier frame is kept
  bool ao = false;                      ///< corners take light
  bool indirect = false;                ///< the sky lights surfaces
  std::vector<glm::uvec4> sky_light{};  ///< what it sends to them, see sky_irradiance()
  ByRadiance by_radiance = ByRadiance::kEverything;
  ShadowPlan shadows{};
  GlassPlan glass{};
  FrameTables tables{};
  FrameContents contents;
  std::optional<CloudPlan> clouds{};                ///< none: the frame has none
  std::optional<shared::MarkerConstants> marker{};  ///< none: none is in view
  std::optional<TemporalPlan> temporal{};  ///< none: the frame is not mixed with earlier ones
  std::uint32_t marked_slices = 0;         ///< see ClusterPicture

  std::vector<std::size_t> steps{};      ///< indices of frame_steps(), in order
  std::vector<gpu::LeftOut> left_out{};  ///< passes and features it lacks, with reasons
  FrameHistory next{};                   ///< without generations of images, which are not made yet

  bool enlarged() const { return !gpu::same_size(picture, shown); }
  bool shows_channel() const;  ///< a debug view takes the place of the lit scene
  /// Whether the picture is mixed from it and earlier ones in an image of its own.
  bool mixes_at_rest() const { return temporal && temporal->at_rest(); }
  bool last_part() const { return input.part + 1 == input.parts; }
  bool lights() const;   ///< the frame's lights are sorted
  bool sampled() const;  ///< light is worked out at fewer pixels than are drawn
};

}  // namespace skerry::render
