#pragma once
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"

namespace skerry::gpu {
class Image;
}

namespace skerry::render {

/// From the picture that is drawn, with `render.scale` below 1, to the larger one that is shown.
struct EnlargePass {
  /// @param shown RGBA8 storage image.
  static Developed add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                       Developed developed, gpu::Image& shown);
};

}  // namespace skerry::render
