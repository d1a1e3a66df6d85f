#pragma once
#include <cstddef>

#include "engine/core/result.h"
#include "engine/gpu/device/device.h"
#include "engine/gpu/graph/bindings.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/render/frame/scene_refs.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/geometry.h"

namespace skerry::render {

enum class DrawList : std::uint32_t { kOpaque = 0, kCutout = 1, kTranslucent = 2 };

struct CullIn {
  std::uint32_t section_slots = 0;  ///< of the geometry store, > 0
  DrawLimits most{};                ///< GeometryStore::most_draws()
  std::uint32_t views = 1;          ///< entries of SceneRefs::views
  /// uint[section]: whether the last frame showed it. Empty: the camera's view is drawn in one
  /// phase.
  gpu::BufferRef seen{};
};

/// Indirect draws of every view and list, in section order.
struct CulledDraws {
  gpu::BufferRef commands;    ///< shared::DrawCommand[view][list][most[list]]
  gpu::BufferRef counts;      ///< uint[view][list]
  gpu::BufferRef stats;       ///< shared::CullStats[view]
  gpu::BufferRef transforms;  ///< shared::SectionTransform[view][section]
  gpu::BufferRef masks;       ///< uint[view][section]: ranges to draw, see cull.comp
  std::uint32_t section_slots = 0;
  DrawLimits most{};

  /// Index in `commands` of a list's first draw.
  std::uint64_t first(std::uint32_t view, DrawList list) const;
};

/// Whether the device draws that many indirectly at once; the error says what to lower.
Result<void> check_draws(const DrawLimits& most, const gpu::DeviceLimits& limits);

/// Frustum and face-direction culling on the GPU for all views at once: three compute passes
/// (sections, scan, emit). The order of draws does not depend on thread timing. Conservative:
/// tested against brute force. In two phases the camera's lists hold the opaque and cut-out quads
/// of what the last frame showed alone.
CulledDraws add_cull_passes(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                            const SceneRefs& scene, const CullIn& in);

/// The second of two phases: holds what is in the camera's view against the depths of what the
/// first has drawn, by squares of pixels (Greene et al., Hierarchical Z-Buffer Visibility, 1993),
/// and writes CullIn::seen. Conservative. @param depth D32, reverse-Z. @param first of
/// add_cull_passes(). @return draws of view 0 alone: opaque and cut-out quads that are seen and not
/// drawn yet, and translucent ones of all that is seen.
CulledDraws add_hidden_passes(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                              const SceneRefs& scene, const CullIn& in, gpu::ImageRef depth,
                              const CulledDraws& first);

/// Push constants of draw_quads.vert.
struct DrawPush {
  glm::mat4 clip_from_source;
  std::uint32_t first_transform;
  float edge_growth;
  float level_growth;  ///< the same of quads that lie level in their lattice
};
inline DrawPush draw_push(const SceneRefs& scene, const CulledDraws& draws, std::uint32_t view) {
  const float growth = scene.edge_growth[view];
  return {scene.clip_from_source[view], view * draws.section_slots, growth, growth};
}

/// What draw_quads.vert declares besides.
inline auto drawn_from(const SceneRefs& scene, const CulledDraws& draws) {
  return std::tuple{gpu::storage<shared::kQuadsBinding>(scene.quads),
                    gpu::storage<shared::kSectionTransformsBinding>(draws.transforms)};
}

/// What draw_quads.vert declares, for one view.
inline auto draw_bindings(const SceneRefs& scene, const CulledDraws& draws, std::uint32_t view) {
  return std::tuple{drawn_from(scene, draws), gpu::constants(draw_push(scene, draws, view))};
}

/// What cutout.glsl declares, which reads materials by word.
inline auto cutout_bindings(const SceneRefs& scene) {
  using shared::Material;
  static_assert(sizeof(Material) == 4 * shared::kMaterialWords &&
                offsetof(Material, layer_side) == 4 * shared::kLayerSideWord &&
                offsetof(Material, layer_top) == 4 * shared::kLayerTopWord &&
                offsetof(Material, layer_bottom) == 4 * shared::kLayerBottomWord);
  return std::tuple{
      gpu::storage<shared::kMaterialsBinding>(scene.materials),
      gpu::sampled<shared::kBlockTexturesBinding>(scene.block_coverage, scene.block_sampler)};
}

/// Records one list of one view into a pass with a program bound for that view.
void draw_list(gpu::Commands& commands, const SceneRefs& scene, const CulledDraws& draws,
               std::uint32_t view, DrawList list);

/// Declares what draw_list() uses.
void declare_draws(gpu::PassBuilder& builder, const SceneRefs& scene, const CulledDraws& draws);

}  // namespace skerry::render
