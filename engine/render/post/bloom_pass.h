#pragma once
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/frame/settings.h"
#include "shaders/shared/bloom.h"

namespace skerry::render {

/// Glow of what is too bright, at half the picture's size.
struct Bloom {
  gpu::ImageRef glow;        ///< RGBA16F, exposed
  shared::BloomStep step{};  ///< from it to the picture
};

/// Takes what is brighter than a threshold, and spreads it over a pyramid of smaller pictures.
/// docs/exposure.md.
struct BloomPass {
  /// @param radiance RGBA16F of the frame's size; what is not finite counts as black.
  static Bloom add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                   gpu::ImageRef radiance, const BloomSettings& settings);
};

/// Runs the bound program, one that calls spread_columns(), over a level.
void dispatch_spread_columns(gpu::Commands& commands, glm::uvec2 fine_size);

/// Levels of a picture's pyramid: as many as asked for, but none after that of a single texel.
std::uint32_t bloom_levels(VkExtent2D size, int asked);

}  // namespace skerry::render
