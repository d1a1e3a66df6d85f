#pragma once
#include "engine/render/frame/phases.h"
#include "engine/render/glass/glass_plan.h"
#include "engine/render/scene/cull_pass.h"

namespace skerry::render {

/// What glass takes of a body's light on its way to what it lights, a layer a map
/// (docs/decisions/0069, 0090).
struct GlassPass {
  struct In {
    const SceneRefs& scene;
    const CulledDraws& draws;
    const Shadows& shadows;  ///< have maps
    const GlassPlan& plan;
    std::uint32_t first_view;  ///< the first map's in the draws; the others follow
  };
  /// To what is opaque.
  /// @return RGBA32F array: optical depth, in the map's area alone. Empty where the device cannot
  /// add up floats.
  static gpu::ImageRef add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const In& in);
  /// To what is translucent.
  /// @return RG32_UINT array, shared::kListedGlass layers a map: see
  /// shaders/include/light/glass_lists.glsl; in the map's area alone.
  static gpu::ImageRef list(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const In& in);
};

}  // namespace skerry::render
