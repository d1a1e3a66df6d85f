#pragma once
#include "engine/render/surface/translucent_pass.h"

namespace skerry::render {

/// Water and glass behind the peeled layers, whatever their number: added up in one draw, in any
/// order (docs/decisions/0054). It works in tiles whose last layer has a surface, and costs little
/// where there is none.
struct TailPass {
  /// @return the layers with their tail; without one on a device that cannot add up floats.
  static TranslucentPass::Layers add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                     const SceneRefs& scene, const CulledDraws& draws,
                                     const Geometry& geometry, TranslucentPass::Layers layers);
};

}  // namespace skerry::render
