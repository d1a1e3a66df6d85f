#pragma once
#include "engine/render/light_clusters.h"
#include "engine/render/phases.h"
#include "engine/render/scene_refs.h"

namespace skerry::render {

/// Adds the light of the frame's lights to opaque surfaces, in the tiles that some light reaches.
struct LightPass {
  /// Corners darken it, and walls block it, as the settings have it.
  static Shaded add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const Geometry& geometry, const ClusteredLights& lights, Shaded shaded,
                    const RenderSettings& settings);
};

}  // namespace skerry::render
