#include "engine/render/post/resolve_pass.h"

#include <shader_names.h>

#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

using gpu::Use;

Shaded ResolvePass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                        Shaded shaded, const In& in) {
  scene.size = in.picture_size;
  const bool accumulates = in.parts > 1;
  const gpu::ImageRef samples = shaded.radiance();
  // Without parts there is no total: one texel of its format is bound in its place.
  gpu::ImageRef total =
      accumulates
          ? graph.import(*in.total)
          : graph.create(gpu::ImageDesc{
                .name = "no total", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .extent = {1, 1}});
  gpu::ImageRef radiance = graph.create(gpu::ImageDesc{.name = "radiance of pixels",
                                                       .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                                       .extent = in.picture_size});
  std::vector<gpu::SpecConstant> constants{
      {shared::kSamplesPerEdgeConstant, static_cast<std::uint32_t>(in.samples_per_edge)}};
  if (accumulates) {
    constants.push_back({shared::kAccumulateConstant, 1});
    constants.push_back({shared::kFirstConstant, in.part == 0 ? 1u : 0u});
  }
  const auto program = gpu::compute(pipelines, programs::kAverageSamples, std::move(constants));
  graph.add_pass(
      accumulates ? "accumulate_part" : "average_samples",
      [&](gpu::PassBuilder& b) {
        b.read(scene.frame, Use::kComputeRead);
        b.read(samples, Use::kComputeRead);
        radiance = b.write(radiance, Use::kComputeWrite);
        total = b.write(total, Use::kComputeWrite);
      },
      [program, frame = scene.frame, samples, radiance, total, in](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(frame),
                  gpu::storage<shared::kSamplesBinding>(samples),
                  gpu::storage<shared::kRadianceBinding>(radiance),
                  gpu::storage<shared::kTotalBinding>(total),
                  gpu::constants(1.0f / static_cast<float>(in.parts)));
        c.dispatch(gpu::Commands::groups(in.picture_size.width, 8),
                   gpu::Commands::groups(in.picture_size.height, 8), 1);
      });
  return Shaded(radiance);
}

}  // namespace skerry::render
