#pragma once
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/frame/settings.h"

namespace skerry::render {

/// What is metered.
struct MeterIn {
  gpu::ImageRef
      radiance;         ///< RGBA16F of the frame's size; nothing of it need be finite. Empty: none
  gpu::ImageRef cells;  ///< ShadeTarget::metered, in place of radiance. Empty: none
};

/// What has been metered.
struct Metered {
  gpu::BufferRef histogram;  ///< shared::kHistogramBins counts
  gpu::ImageRef radiance;    ///< that they are of
};

/// Light meter: a histogram of scene radiance, and the exposure that it asks for. docs/exposure.md.
struct MeterPass {
  /// @param decides the picture is developed at what is metered; else it is only reported.
  static Metered add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                     const MeterIn& in, const MeterSettings& settings, bool decides);
  /// Draws the histogram over the picture.
  /// @param metered of add(), and with the same settings.
  static Developed show(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                        Developed developed, const Metered& metered, const MeterSettings& settings);
};

}  // namespace skerry::render
