#include "engine/render/post/temporal_pass.h"

#include <shader_names.h>
#include <utility>
#include <vector>

#include "engine/gpu/graph/bindings.h"
#include "engine/render/scene/tiles.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

using gpu::Use;

Developed TemporalPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                            const SceneRefs& scene, const Geometry& geometry, SmoothEdges fresh,
                            const In& in) {
  const gpu::ImageRef shown = fresh.picture.picture(), words = geometry.surfaces(),
                      depth = geometry.depth(), water = in.water_depth;
  const EdgeLists lists = fresh.lists;
  const gpu::BufferRef motions = graph.import(in.kept.motions());
  gpu::ImageRef pictures = graph.import(in.kept.pictures()), keys = graph.import(in.kept.keys()),
                out = in.plan.at_rest() ? graph.import(in.picture) : shown;
  // In motion most pixels stay as they are, and those at edges are mixed in place.
  const gpu::ImageRef fresh_picture = in.plan.at_rest() ? shown : depth;
  const std::vector<gpu::SpecConstant> mixing{{shared::kTranslucentConstant, water ? 1u : 0u},
                                              {shared::kCloudLayerConstant, in.clouds ? 1u : 0u}};
  for (const bool edges : {false, true}) {
    // At rest all pixels are mixed as edges are.
    if (edges && !in.plan.moves()) continue;
    std::vector<gpu::SpecConstant> constants{{shared::kStoreConstant, 1}};
    if (edges || in.plan.at_rest()) {
      constants = mixing;
      constants.push_back({shared::kEdgesConstant, edges ? 1u : 0u});
    }
    graph.add_pass(
        edges ? "mix_edges" : "mix_at_rest",
        [&](gpu::PassBuilder& b) {
          for (const gpu::BufferRef ref : {scene.frame, motions, lists.tiles, lists.dispatches})
            b.read(ref, Use::kComputeRead);
          if (edges) b.read(lists.dispatches, Use::kIndirect);
          b.read(words, Use::kComputeRead);
          for (const gpu::ImageRef ref : {depth, fresh_picture}) b.read(ref, Use::kComputeSampled);
          if (water) b.read(water, Use::kComputeSampled);
          pictures = b.write(pictures, Use::kComputeWrite);
          keys = b.write(keys, Use::kComputeWrite);
          out = b.write(out, Use::kComputeWrite);
        },
        [scene, motions, lists, words, depth, fresh_picture, water, pictures, keys, out, edges,
         step = in.plan.step,
         program = gpu::compute(pipelines, programs::kMixFrames, std::move(constants))](
            gpu::Commands& c) {
          const VkSampler point = scene.point_sampler;
          gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                    gpu::texels<shared::kMotionsBinding>(motions),
                    gpu::storage<shared::kTilesBinding>(lists.tiles),
                    gpu::storage<shared::kTileDispatchesBinding>(lists.dispatches),
                    gpu::storage<shared::kSurfacesBinding>(words),
                    gpu::sampled<shared::kDepthsBinding>(depth, point),
                    gpu::sampled<shared::kLayerDepthsBinding>(water ? water : depth, point),
                    gpu::sampled<shared::kFreshPictureBinding>(fresh_picture, point),
                    gpu::storage<shared::kKeptPicturesBinding>(pictures, gpu::kAllLayers),
                    gpu::storage<shared::kKeptKeysBinding>(keys, gpu::kAllLayers),
                    gpu::storage<shared::kPictureBinding>(out), gpu::constants(step));
          if (edges)
            c.dispatch_indirect(lists.dispatches, 2 * sizeof(shared::TileDispatch));
          else
            c.dispatch(gpu::Commands::groups(scene.size.width, shared::kTileEdge),
                       gpu::Commands::groups(scene.size.height, shared::kTileEdge), 1);
        });
  }
  return Developed(out);
}

}  // namespace skerry::render
