#include "engine/render/post/resolve_pass.h"

#include "engine/render/post/radiance_filter.h"

namespace skerry::render {

using gpu::Use;

Shaded ResolvePass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                        Shaded shaded, const In& in) {
  scene.size = in.picture_size;
  const bool accumulates = in.parts > 1;
  const gpu::ImageRef samples = shaded.radiance();
  // Without parts there is no total: one texel of its format is bound in its place.
  gpu::ImageRef total = accumulates ? graph.import(*in.total) : RadianceFilter::no_total(graph);
  gpu::ImageRef radiance = graph.create(gpu::ImageDesc{.name = "radiance of pixels",
                                                       .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                                       .extent = in.picture_size});
  std::vector<gpu::SpecConstant> constants{
      {shared::kSamplesPerEdgeConstant, static_cast<std::uint32_t>(in.samples_per_edge)}};
  if (accumulates) {
    constants.push_back({shared::kAccumulateConstant, 1});
    constants.push_back({shared::kFirstConstant, in.part == 0 ? 1u : 0u});
  }
  const VkExtent2D size = in.picture_size;
  RadianceFilter filter{samples, samples, radiance, total, scene.frame};  // nothing is exposed
  filter.push.step.coarse_size = {size.width, size.height};
  filter.push.share = 1.0f / static_cast<float>(in.parts);
  graph.add_pass(
      accumulates ? "accumulate_part" : "average_samples",
      [&](gpu::PassBuilder& b) {
        b.read(scene.frame, Use::kComputeRead);
        b.read(samples, Use::kComputeRead);
        radiance = b.write(radiance, Use::kComputeWrite);
        total = b.write(total, Use::kComputeWrite);
      },
      [filter, size,
       program = RadianceFilter::program(pipelines, shared::kFilterAverage, std::move(constants))](
          gpu::Commands& c) {
        gpu::bind(c, program, filter.bindings());
        c.dispatch(gpu::Commands::groups(size.width, 8), gpu::Commands::groups(size.height, 8), 1);
      });
  return Shaded(radiance);
}

}  // namespace skerry::render
