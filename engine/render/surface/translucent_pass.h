#pragma once
#include <array>

#include "engine/render/frame/phases.h"
#include "engine/render/frame/settings.h"
#include "engine/render/light/light_clusters.h"
#include "engine/render/scene/cull_pass.h"
#include "engine/render/scene/tiles.h"

namespace skerry::render {

/// Water and glass: the nearest surfaces of each pixel are peeled into layers (Everitt, Interactive
/// Order-Independent Transparency, 2001), exact order a pixel whatever the order of draws, then
/// looked through in compute with the light functions of the opaque pass (docs/decisions/0005).
struct TranslucentPass {
  /// The peeled surfaces, nearest first.
  struct Layers {
    gpu::ImageRef surfaces;  ///< array of words, of any value where there is no surface; behind
                             ///< them what add_layer_light() finds, if `shares`
    std::array<gpu::ImageRef, 4> depth;  ///< read through shaders/include/scene/layers.glsl:
                                         ///< reverse-Z, 0 where there is no surface
    std::uint32_t count = 0;
    bool shares = false;
    Tiles tiles;                            ///< kCovered: those with a surface of the nearest one
    gpu::ImageRef tail_depths, tail_light;  ///< of TailPass; empty: what is behind is not drawn
    gpu::ImageRef mirrored_clouds;          ///< CloudPass::add_mirrored(); empty: none are mirrored

    /// Layers that are not kept are never read; the first one is bound in their place so that every
    /// binding is valid.
    auto depth_bindings(VkSampler point) const {
      return gpu::each_of<shared::kLayerDepthsBinding, 4>(
          [&]<std::uint32_t kBinding>(std::size_t k) {
            return gpu::sampled<kBinding>(depth[k < count ? k : 0], point);
          });
    }
    auto bindings(VkSampler point) const {
      return std::tuple{
          gpu::sampled<shared::kLayerSurfacesBinding>(surfaces, point),
          gpu::sampled<shared::kTailDepthsBinding>(tail_depths ? tail_depths : depth[0], point),
          gpu::sampled<shared::kTailLightBinding>(tail_light ? tail_light : depth[0], point),
          depth_bindings(point)};
    }
  };
  struct Kept {
    int layers;          ///< surfaces a pixel, 1..4
    bool inside_medium;  ///< as below; then tiles of the whole picture are sorted
    bool shares;         ///< of light that comes through stained glass
  };
  static Layers draw(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                     const CulledDraws& draws, const Geometry& geometry, const Kept& kept);
  struct In {
    const Geometry& geometry;
    const Shadows& shadows;
    const Layers& layers;
    const ClusteredLights* lights;  ///< null: there are none. Walls block all of them, if any.
    const RenderSettings& settings;
    bool inside_medium;  ///< the camera itself is in a translucent block
  };
  static Shaded add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const In& in, Shaded shaded);
};

}  // namespace skerry::render
