#pragma once
#include "engine/render/phases.h"
#include "engine/render/scene_refs.h"

namespace skerry::render {

/// Light for every pixel, in compute: surfaces under sun and moon, sky elsewhere.
struct ShadePass {
  /// The usual frame. @param texture_taps samples along the long side of a texture footprint.
  static Shaded add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene, const Geometry& geometry, const Shadows& shadows,
                    int texture_taps);
  /// A frame without geometry: sky alone.
  static Shaded add_sky_only(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene);
};

}  // namespace skerry::render
