#pragma once
#include <optional>

#include "engine/render/frame/phases.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/surface/sample_pass.h"

namespace skerry::gpu {
class Image;
}

namespace skerry::render {

struct ShadeIn {
  int texture_taps = 2;  ///< samples along the long side of a texture footprint
  bool stars = false;    ///< whether any star can be seen
  bool discs = true;     ///< whether the sun's or the moon's disc may be in the picture
  /// None: the sun and the moon light every pixel. Else add() lights fewer, with the lights too.
  std::optional<SampledLight> sampled{};
};

/// What opaque surfaces are shaded from.
struct ShadedFrom {
  const Geometry& geometry;
  const Shadows& shadows;
};

/// Light for every pixel, in compute, by tiles: surfaces under sun and moon, sky elsewhere.
struct ShadePass {
  /// To scene radiance, for the passes that follow.
  static Shaded add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                    const ShadedFrom& from, const ShadeIn& in);
  /// Straight to the picture, when nothing comes between: two image passes less.
  static Developed add_to_picture(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                  SceneRefs& scene, const ShadedFrom& from, const ShadeIn& in,
                                  gpu::Image& picture);
  /// A frame without geometry: sky alone, to scene radiance or straight to the picture.
  static Shaded add_sky_only(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                             const ShadeIn& in);
  static Developed add_sky_only_to_picture(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                                           SceneRefs& scene, const ShadeIn& in,
                                           gpu::Image& picture);
};

}  // namespace skerry::render
