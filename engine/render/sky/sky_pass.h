#pragma once
#include "engine/render/frame/scene_refs.h"

namespace skerry::render {

/// Bakes the sky's radiance into its table (shaders/sky/bake_sky.comp), when sun or moon have
/// moved.
/// @return the table's new version.
gpu::ImageRef add_sky_pass(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                           const SceneRefs& scene);

}  // namespace skerry::render
