#include "engine/render/post/temporal_pass.h"

#include <shader_names.h>

#include "engine/gpu/graph/bindings.h"
#include "engine/render/scene/tiles.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

using gpu::Use;

namespace {

std::vector<gpu::SpecConstant> constants(const TemporalPass::In& in, bool plane) {
  return {{shared::kTranslucentConstant, in.water_depth ? 1u : 0u},
          {shared::kCloudLayerConstant, in.clouds ? 1u : 0u},
          {shared::kPlaneConstant, plane ? 1u : 0u}};
}

/// Lists tiles with edges, then those of one plane.
Tiles find_tiles(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                 gpu::ImageRef depth, const TemporalPass::In& in) {
  const std::uint32_t tiles = tile_count(scene.size);
  Tiles out = create_tiles(graph, "find_mixed_tiles_clear", tiles);
  std::vector<gpu::SpecConstant> chosen = constants(in, false);
  chosen.pop_back();
  graph.add_pass(
      "find_mixed_tiles",
      [&](gpu::PassBuilder& b) {
        b.read(scene.frame, Use::kComputeRead);
        b.read(depth, Use::kComputeSampled);
        out.dispatches = b.write(out.dispatches, Use::kComputeWrite);
        out.lists = b.write(out.lists, Use::kComputeWrite);
      },
      [scene, depth, out, step = in.plan.step, tiles,
       program = gpu::compute(pipelines, programs::kFindMixedTiles, std::move(chosen))](
          gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::sampled<shared::kDepthsBinding>(depth, scene.point_sampler),
                  gpu::storage<shared::kTileDispatchesBinding>(out.dispatches),
                  gpu::storage<shared::kTilesBinding>(out.lists), gpu::constants(step));
        dispatch_items(c, tiles);
      });
  return out;
}

}  // namespace

Developed TemporalPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines,
                            const SceneRefs& scene, const Geometry& geometry, Developed fresh,
                            const In& in) {
  const std::uint32_t frame = in.plan.frame;
  KeptFrames::Frame& before = in.kept.of(frame + 1);
  const gpu::ImageRef shaded = fresh.picture(), words = geometry.surfaces(),
                      depth = geometry.depth(), water = in.water_depth;
  const gpu::ImageRef kept_words = graph.import(before.surfaces),
                      kept_depth = graph.import(before.depth),
                      kept_mixed = graph.import(before.mixed);
  const gpu::BufferRef motions = graph.import(in.kept.motions());
  gpu::ImageRef mixed = graph.import(in.kept.of(frame).mixed), out = graph.import(in.picture);
  const Tiles tiles = find_tiles(graph, pipelines, scene, depth, in);
  for (const bool plane : {true, false})
    graph.add_pass(
        plane ? "mix_planes" : "mix_edges",
        [&](gpu::PassBuilder& b) {
          b.read(scene.frame, Use::kComputeRead);
          b.read(motions, Use::kComputeRead);
          declare_tiles(b, tiles);
          for (const gpu::ImageRef ref : {words, kept_words}) b.read(ref, Use::kComputeRead);
          for (const gpu::ImageRef ref : {depth, kept_depth, kept_mixed, shaded})
            b.read(ref, Use::kComputeSampled);
          if (water) b.read(water, Use::kComputeSampled);
          mixed = b.write(mixed, Use::kComputeWrite);
          out = b.write(out, Use::kComputeWrite);
        },
        [scene, motions, tiles, words, kept_words, depth, kept_depth, kept_mixed, shaded, water,
         mixed, out, plane, step = in.plan.step,
         program = gpu::compute(pipelines, programs::kMixFrames, constants(in, plane))](
            gpu::Commands& c) {
          const VkSampler point = scene.point_sampler;
          gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                    gpu::texels<shared::kMotionsBinding>(motions),
                    gpu::storage<shared::kTilesBinding>(tiles.lists),
                    gpu::storage<shared::kTileDispatchesBinding>(tiles.dispatches),
                    gpu::storage<shared::kSurfacesBinding>(words),
                    gpu::sampled<shared::kDepthsBinding>(depth, point),
                    gpu::sampled<shared::kLayerDepthsBinding>(water ? water : depth, point),
                    gpu::sampled<shared::kFreshPictureBinding>(shaded, point),
                    gpu::storage<shared::kKeptSurfacesBinding>(kept_words),
                    gpu::sampled<shared::kKeptDepthsBinding>(kept_depth, point),
                    gpu::sampled<shared::kKeptPictureBinding>(kept_mixed, scene.lut_sampler),
                    gpu::storage<shared::kMixedPictureBinding>(mixed),
                    gpu::storage<shared::kPictureBinding>(out), gpu::constants(step));
          c.dispatch_indirect(tiles.dispatches, (plane ? 1 : 0) * sizeof(shared::TileDispatch));
        });
  return Developed(out);
}

}  // namespace skerry::render
