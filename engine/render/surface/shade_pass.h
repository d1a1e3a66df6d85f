#pragma once
#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/surface/sample_pass.h"

namespace skerry::gpu {
class Image;
}

namespace skerry::render {

struct ShadeIn {
  const RenderSettings& settings;
  bool stars = false;  ///< whether any star can be seen
  bool discs = true;   ///< whether the sun's or the moon's disc may be in the picture
  const ClusteredLights* lamps = nullptr;  ///< null: the frame has none
  bool sampled = false;                    ///< light is that of fewer pixels: add_sample_passes()
};

/// What opaque surfaces are shaded from.
struct ShadedFrom {
  const Geometry& geometry;
  const Shadows& shadows;
  const TranslucentPass::Layers& layers;
  gpu::ImageRef glass;  ///< maps of GlassPass; empty: glass takes no light
};

/// Where shading puts pixels.
struct ShadeOut {
  ByRadiance by_radiance;
  gpu::Image& picture;           ///< RGBA8, of the frame's size
  const MeterSettings* metered;  ///< null: the meter looks at nothing that is in the picture
};

/// Light for every pixel, in compute, by tiles: surfaces under sun, moon and lamps, sky elsewhere.
struct ShadePass {
  /// @param from null: a frame without geometry, of sky alone.
  static Shaded add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const ShadedFrom* from, const ShadeIn& in, const ShadeOut& out);
};

}  // namespace skerry::render
