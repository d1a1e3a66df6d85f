#include "engine/render/post/temporal_pass.h"

#include <shader_names.h>

#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

using gpu::Use;

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
  graph.add_pass(
      "mix_frames",
      [&](gpu::PassBuilder& b) {
        b.read(scene.frame, Use::kComputeRead);
        b.read(motions, Use::kComputeRead);
        for (const gpu::ImageRef ref : {words, kept_words}) b.read(ref, Use::kComputeRead);
        for (const gpu::ImageRef ref : {depth, kept_depth, kept_mixed, shaded})
          b.read(ref, Use::kComputeSampled);
        if (water) b.read(water, Use::kComputeSampled);
        mixed = b.write(mixed, Use::kComputeWrite);
        out = b.write(out, Use::kComputeWrite);
      },
      [scene, motions, words, kept_words, depth, kept_depth, kept_mixed, shaded, water, mixed, out,
       step = in.plan.step,
       program =
           gpu::compute(pipelines, programs::kMixFrames,
                        {{shared::kTranslucentConstant, water ? 1u : 0u},
                         {shared::kCloudLayerConstant, in.clouds ? 1u : 0u}})](gpu::Commands& c) {
        const VkSampler point = scene.point_sampler;
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(scene.frame),
                  gpu::texels<shared::kMotionsBinding>(motions),
                  gpu::storage<shared::kSurfacesBinding>(words),
                  gpu::sampled<shared::kDepthsBinding>(depth, point),
                  gpu::sampled<shared::kLayerDepthsBinding>(water ? water : depth, point),
                  gpu::sampled<shared::kFreshPictureBinding>(shaded, point),
                  gpu::storage<shared::kKeptSurfacesBinding>(kept_words),
                  gpu::sampled<shared::kKeptDepthsBinding>(kept_depth, point),
                  gpu::sampled<shared::kKeptPictureBinding>(kept_mixed, scene.lut_sampler),
                  gpu::storage<shared::kMixedPictureBinding>(mixed),
                  gpu::storage<shared::kPictureBinding>(out), gpu::constants(step));
        c.dispatch(gpu::Commands::groups(scene.size.width, 8),
                   gpu::Commands::groups(scene.size.height, 8), 1);
      });
  return Developed(out);
}

}  // namespace skerry::render
