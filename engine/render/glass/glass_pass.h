#pragma once
#include "engine/render/frame/phases.h"
#include "engine/render/glass/glass_plan.h"
#include "engine/render/scene/cull_pass.h"

namespace skerry::render {

/// What glass takes of a body's light on its way to what it lights, one pass a cascade
/// (docs/decisions/0069).
struct GlassPass {
  /// @param first_view the first map's in the draws; the others follow. @param shadows have maps.
  /// @return RGBA32F array, a layer a map: optical depth, in the map's area alone. Empty where the
  /// device cannot add up floats.
  static gpu::ImageRef add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                           const SceneRefs& scene, const CulledDraws& draws, const Shadows& shadows,
                           const GlassPlan& plan, std::uint32_t first_view);
};

}  // namespace skerry::render
