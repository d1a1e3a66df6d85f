#pragma once
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/frame/settings.h"

namespace skerry::render {

/// Light meter: a histogram of scene radiance, and the exposure that it asks for. docs/exposure.md.
struct MeterPass {
  /// @param radiance RGBA16F of the frame's size; nothing of it need be finite.
  /// @param decides the picture is developed at what is metered; else it is only reported.
  /// @return the histogram: shared::kHistogramBins counts.
  static gpu::BufferRef add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                            gpu::ImageRef radiance, const MeterSettings& settings, bool decides);
  /// Draws the histogram over the picture.
  /// @param histogram of add(), and with the same settings.
  static Developed show(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                        Developed developed, gpu::BufferRef histogram,
                        const MeterSettings& settings);
};

}  // namespace skerry::render
