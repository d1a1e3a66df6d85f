#pragma once
#include "engine/render/light_clusters.h"
#include "engine/render/phases.h"
#include "engine/render/scene_refs.h"

namespace skerry::render {

/// Adds the light of the frame's lights to opaque surfaces, in the tiles that some light reaches.
struct LightPass {
  /// @param texture_taps see RenderSettings.
  static Shaded add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const Geometry& geometry, const ClusteredLights& lights, Shaded shaded,
                    int texture_taps);
};

}  // namespace skerry::render
