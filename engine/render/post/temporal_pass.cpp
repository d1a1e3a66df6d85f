#include "engine/render/post/temporal_pass.h"

#include <shader_names.h>

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
                out = graph.import(in.picture);
  for (const bool edges : {false, true})
    graph.add_pass(
        edges ? "mix_edges" : "mix_at_rest",
        [&](gpu::PassBuilder& b) {
          for (const gpu::BufferRef ref : {scene.frame, motions, lists.tiles, lists.dispatches})
            b.read(ref, Use::kComputeRead);
          if (edges) b.read(lists.dispatches, Use::kIndirect);
          b.read(words, Use::kComputeRead);
          for (const gpu::ImageRef ref : {depth, shown}) b.read(ref, Use::kComputeSampled);
          if (water) b.read(water, Use::kComputeSampled);
          pictures = b.write(pictures, Use::kComputeWrite);
          keys = b.write(keys, Use::kComputeWrite);
          out = b.write(out, Use::kComputeWrite);
        },
        [scene, motions, lists, words, depth, shown, water, pictures, keys, out, edges,
         step = in.plan.step,
         program = gpu::compute(pipelines, programs::kMixFrames,
                                {{shared::kTranslucentConstant, water ? 1u : 0u},
                                 {shared::kCloudLayerConstant, in.clouds ? 1u : 0u},
                                 {shared::kEdgesConstant, edges ? 1u : 0u}})](gpu::Commands& c) {
          const VkSampler point = scene.point_sampler;
          gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                    gpu::texels<shared::kMotionsBinding>(motions),
                    gpu::storage<shared::kTilesBinding>(lists.tiles),
                    gpu::storage<shared::kTileDispatchesBinding>(lists.dispatches),
                    gpu::storage<shared::kSurfacesBinding>(words),
                    gpu::sampled<shared::kDepthsBinding>(depth, point),
                    gpu::sampled<shared::kLayerDepthsBinding>(water ? water : depth, point),
                    gpu::sampled<shared::kFreshPictureBinding>(shown, point),
                    gpu::storage<shared::kKeptPicturesBinding>(pictures, gpu::kAllLayers),
                    gpu::storage<shared::kKeptKeysBinding>(keys, gpu::kAllLayers),
                    gpu::storage<shared::kPictureBinding>(out), gpu::constants(step));
          if (edges)
            c.dispatch_indirect(lists.dispatches, 2 * sizeof(shared::TileDispatch));
          else
            c.dispatch(gpu::Commands::groups(scene.size.width, shared::kTileEdge),
                       gpu::Commands::groups(scene.size.height, shared::kTileEdge), 1);
        });
  return Developed(out);
}

}  // namespace skerry::render
