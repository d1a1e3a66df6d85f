#pragma once
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/frame/settings.h"
#include "engine/render/light/light_clusters.h"
#include "engine/render/post/bloom_pass.h"

namespace skerry::gpu {
class Image;
}

namespace skerry::render {

/// Radiance to picture: exposure, tone curve, sRGB; or a debug view of what the frame holds.
struct DevelopPass {
  /// Of the pixels that are not in the picture already; no pass at all if all are.
  /// @param bloom null: none. @param picture RGBA8 storage image of the frame's size, the one that
  /// shading wrote to.
  static Developed add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                       Shaded shaded, const Bloom* bloom, gpu::Image& picture);
  struct DebugIn {
    const Geometry& geometry;
    const Shadows& shadows;
    const ClusteredLights* lights;  ///< null: there are none
    DebugView view;
  };
  static Developed add_debug(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                             const DebugIn& in, gpu::Image& picture);
};

}  // namespace skerry::render
