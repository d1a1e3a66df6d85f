#pragma once
#include "engine/render/bloom_pass.h"
#include "engine/render/light_clusters.h"
#include "engine/render/phases.h"
#include "engine/render/scene_refs.h"
#include "engine/render/settings.h"

namespace skerry::gpu {
class Image;
}

namespace skerry::render {

/// Radiance to picture: exposure, tone curve, sRGB; or a debug view of what the frame holds.
struct DevelopPass {
  /// @param bloom null: none. @param picture RGBA8 storage image of the frame's size.
  static Developed add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                       Shaded shaded, const Bloom* bloom, gpu::Image& picture);
  /// @param lights null: there are none.
  static Developed add_debug(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                             const Geometry& geometry, const Shadows& shadows,
                             const ClusteredLights* lights, DebugView view, gpu::Image& picture);
};

}  // namespace skerry::render
