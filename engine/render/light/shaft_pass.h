#pragma once
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/light/light_clusters.h"

namespace skerry::render {

/// Finds which lights of its lists each 8x8-pixel tile need not ask and which nothing stands
/// before: the same picture, for less (docs/decisions/0058).
struct ShaftPass {
  struct In {
    const Geometry& geometry;
    const RenderSettings& settings;
  };
  /// @return `lights`, with what was found.
  static ClusteredLights add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                             const SceneRefs& scene, const In& in, ClusteredLights lights);
};

}  // namespace skerry::render
