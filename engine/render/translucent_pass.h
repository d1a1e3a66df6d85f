#pragma once
#include "engine/render/cull_pass.h"
#include "engine/render/phases.h"

namespace skerry::render {

/// Water and glass: the nearest surfaces of each pixel are peeled into layers (Everitt, Interactive
/// Order-Independent Transparency, 2001), exact order a pixel whatever the order of draws, then
/// looked through in compute with the light functions of the opaque pass (docs/decisions/0005).
struct TranslucentPass {
  /// @param inside_medium the camera itself is in a translucent block.
  /// @param layers surfaces kept a pixel, 1..4: what lies behind the last one is seen as if nothing
  /// translucent followed.
  static Shaded add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const CulledDraws& draws, const Geometry& geometry, const Shadows& shadows,
                    Shaded shaded, int layers, bool inside_medium);
};

}  // namespace skerry::render
