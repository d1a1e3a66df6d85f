#pragma once
#include <vector>

#include "engine/render/features.h"
#include "engine/render/frame_setup.h"
#include "shaders/shared/sky.h"

namespace skerry::render {

/// What one frame has to show.
struct FrameContents {
  FrameFeatures features;
  std::vector<bool> cutouts_in_view;  ///< one a view of FrameTables
  std::vector<shared::Light> lights;  ///< those whose range the view touches; empty: no feature
};

/// Asked of the tables as they are before culling is frozen: a frozen camera changes what is drawn,
/// never which passes a picture has. @param cloud_volumes whether there are clouds of files.
FrameContents contents_of(const FrameInput& input, const RenderSettings& settings,
                          const FrameTables& tables, const shared::SkyConstants& sky,
                          const GeometryStore& geometry, bool cloud_volumes);

}  // namespace skerry::render
