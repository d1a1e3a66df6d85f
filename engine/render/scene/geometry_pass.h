#pragma once
#include "engine/render/frame/phases.h"
#include "engine/render/scene/cull_pass.h"

namespace skerry::render {

/// Draws opaque and cut-out quads of the camera's view: 4 bytes of surface word and 4 of depth a
/// pixel. Position comes back from the depth, the exact normal from word and island, albedo from
/// position and block textures (docs/decisions/0002).
struct GeometryPass {
  struct In {
    const GBufferStore& store;  ///< what is written besides the word, see gbuffer_formats.h
    bool cutouts = true;        ///< false leaves the pass's alpha-tested half out
    bool blended = false;       ///< some sections are drawn in some pixels alone, by that half
    /// Tests alpha on the finest texels, as suits several samples a pixel; mips of thin plants keep
    /// nothing of them where a block is smaller than a sample.
    bool finest_coverage = false;
    bool clear_words = false;  ///< for who reads them without depth; with 16 bits of depth they are
  };
  static Geometry add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                      const CulledDraws& draws, const In& in);
  /// Draws more of the same view. @param draws of add_hidden_passes(). @param in as add() had it.
  static Geometry add_revealed(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                               const SceneRefs& scene, const CulledDraws& draws, const In& in,
                               Geometry&& drawn);

 private:
  static void add_pass(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                       const CulledDraws& draws, const In& in, bool revealed, Geometry& out);
};

}  // namespace skerry::render
