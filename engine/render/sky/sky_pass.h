#pragma once
#include "engine/render/frame/scene_refs.h"

namespace skerry::render {

/// Bakes the sky's radiance into its table (shaders/sky/bake_sky.comp), when sun, moon or the eye's
/// height have changed.
/// @return the table's new version.
gpu::ImageRef add_sky_pass(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                           const SceneRefs& scene);

}  // namespace skerry::render
