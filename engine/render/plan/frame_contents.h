#pragma once
#include <vector>

#include "engine/render/frame/features.h"
#include "engine/render/plan/frame_tables.h"
#include "engine/render/plan/scene_facts.h"
#include "shaders/shared/sky.h"

namespace skerry::render {

/// What one frame has to show.
struct FrameContents {
  FrameFeatures features;
  std::vector<bool> cutouts_in_view;  ///< one a view of FrameTables
  glm::uvec4 layers_area;             ///< see shared::FrameConstants
  std::vector<shared::Light> lights;  ///< those whose range the view touches; empty: no feature
  bool blended = false;               ///< the camera may see sections that are drawn in part
};

/// Asked of the tables as they are before culling is frozen: a frozen camera changes what is drawn,
/// never which passes a picture has.
FrameContents contents_of(const FrameInput& input, const RenderSettings& settings,
                          const FrameTables& tables, const shared::SkyConstants& sky,
                          const SceneFacts& facts);

/// Slices of depth in which lights show without a surface: about an eye in water, and in clouds.
std::uint32_t marked_slices(const FrameInput& input, const FrameContents& contents);

}  // namespace skerry::render
