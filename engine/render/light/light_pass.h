#pragma once
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/light/light_clusters.h"

namespace skerry::render {

/// Adds the light of the frame's lights to opaque surfaces, in the tiles that some light reaches.
struct LightPass {
  struct In {
    const Geometry& geometry;
    const ClusteredLights& lights;
    const RenderSettings& settings;
  };
  /// Corners darken it, and walls block it, as the settings have it.
  static Shaded add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const In& in, Shaded shaded);
};

}  // namespace skerry::render
