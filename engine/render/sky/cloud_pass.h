#pragma once
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/frame/settings.h"
#include "engine/render/surface/translucent_pass.h"

namespace skerry::render {

/// Clouds before what is shaded: marched once for every pixel, or for every fourth and along edges.
/// docs/clouds.md.
struct CloudPass {
  /// What a ray has before it.
  struct View {
    const Geometry* geometry = nullptr;  ///< null: nothing but sky
    gpu::ImageRef shadow_maps;           ///< empty: nothing casts
    gpu::ImageRef layer_depth;           ///< of the nearest water or glass; empty: there is none
    const ClusteredLights* lights = nullptr;  ///< null: there are none
  };
  /// Clouds that the nearest surfaces of water or glass mirror. @pre layers.count != 0, and sun or
  /// moon gives light: without, no sky is mirrored. @return as
  /// shaders/include/sky/mirrored_clouds.glsl reads it.
  static gpu::ImageRef add_mirrored(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                    const SceneRefs& scene, const View& view,
                                    const TranslucentPass::Layers& layers);
  /// Clouds behind the nearest water or glass. @pre view.layer_depth
  static Shaded add_behind(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                           const View& view, Shaded shaded, const RenderSettings& settings);
  /// Clouds before it, and everywhere else.
  static Shaded add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const View& view, Shaded shaded, const RenderSettings& settings);
};

}  // namespace skerry::render
