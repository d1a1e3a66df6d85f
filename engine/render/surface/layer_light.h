#pragma once
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/surface/translucent_pass.h"

namespace skerry::render {

struct LayerLightIn {
  const SceneRefs& scene;
  const Shadows& shadows;  ///< that the glass belongs to
  gpu::ImageRef glass;     ///< of GlassPass::list()
  const TranslucentPass::Layers& layers;
  bool inside_medium;  ///< the camera itself is in a translucent block
};

/// What stained glass leaves of sun or moon on its way to each layer (docs/decisions/0090).
/// @pre layers.shares. @return layers.surfaces with it.
gpu::ImageRef add_layer_light(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                              const LayerLightIn& in);

}  // namespace skerry::render
