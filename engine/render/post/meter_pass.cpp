#include "engine/render/post/meter_pass.h"

#include <shader_names.h>

#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/exposure.h"

namespace skerry::render {

using gpu::Use;

static_assert(shared::kMeterGroup * shared::kMeterGroup == shared::kHistogramBins);

namespace {

shared::Metering metering_of(const MeterSettings& settings, bool decides) {
  return {settings.key, settings.min_ev, settings.max_ev,
          static_cast<std::uint32_t>(settings.stride), decides ? 1u : 0u};
}

}  // namespace

gpu::BufferRef MeterPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                              gpu::ImageRef radiance, const MeterSettings& settings, bool decides) {
  const shared::Metering metering = metering_of(settings, decides);
  gpu::BufferRef histogram =
      graph.create(gpu::BufferDesc{"histogram", shared::kHistogramBins * sizeof(std::uint32_t)});
  graph.add_pass(
      "clear_histogram",
      [&](gpu::PassBuilder& b) { histogram = b.write(histogram, Use::kTransferWrite); },
      [histogram](gpu::Commands& c) { c.fill(histogram, 0, VK_WHOLE_SIZE, 0); });
  graph.add_pass(
      "meter_radiance",
      [&](gpu::PassBuilder& b) {
        b.read(scene.frame, Use::kComputeRead);
        b.read(radiance, Use::kComputeRead);
        scene.exposure = b.write(scene.exposure, Use::kComputeWrite);  // by the shader's other step
        histogram = b.write(histogram, Use::kComputeWrite);
      },
      [frame = scene.frame, size = scene.size, radiance, histogram, metering,
       exposure = scene.exposure,
       program = gpu::compute(pipelines, programs::kMeterRadiance)](gpu::Commands& c) {
        const auto groups = [&](std::uint32_t pixels) {
          return gpu::Commands::groups(gpu::Commands::groups(pixels, metering.stride),
                                       shared::kMeterGroup);
        };
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(frame),
                  gpu::storage<shared::kRadianceBinding>(radiance),
                  gpu::storage<shared::kHistogramBinding>(histogram),
                  gpu::storage<shared::kExposureBinding>(exposure), gpu::constants(metering));
        c.dispatch(groups(size.width), groups(size.height), 1);
      });
  graph.add_pass(
      "choose_exposure",
      [&](gpu::PassBuilder& b) {
        b.read(scene.frame, Use::kComputeRead);
        b.read(radiance, Use::kComputeRead);
        b.read(histogram, Use::kComputeRead);
        scene.exposure = b.write(scene.exposure, Use::kComputeWrite);
      },
      [frame = scene.frame, radiance, histogram, exposure = scene.exposure, metering,
       program = gpu::compute(pipelines, programs::kMeterRadiance, {{shared::kChooseConstant, 1}})](
          gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(frame),  // neither this
                  gpu::storage<shared::kRadianceBinding>(radiance),        // nor this is read
                  gpu::storage<shared::kHistogramBinding>(histogram),
                  gpu::storage<shared::kExposureBinding>(exposure), gpu::constants(metering));
        c.dispatch(1, 1, 1);
      });
  return histogram;
}

Developed MeterPass::show(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                          Developed developed, gpu::BufferRef histogram,
                          const MeterSettings& settings) {
  gpu::ImageRef picture = developed.picture();
  graph.add_pass(
      "show_exposure",
      [&](gpu::PassBuilder& b) {
        for (const gpu::BufferRef ref : {scene.frame, histogram, scene.exposure})
          b.read(ref, Use::kComputeRead);
        picture = b.write(picture, Use::kComputeWrite);
      },
      [picture, histogram, frame = scene.frame, exposure = scene.exposure, size = scene.size,
       metering = metering_of(settings, false),
       program = gpu::compute(pipelines, programs::kShowExposure)](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFrameBinding>(frame),
                  gpu::storage<shared::kHistogramBinding>(histogram),
                  gpu::storage<shared::kExposureBinding>(exposure),
                  gpu::storage<shared::kPictureBinding>(picture), gpu::constants(metering));
        c.dispatch(gpu::Commands::groups(size.width, 8),
                   gpu::Commands::groups((size.height + 2) / 3, 8), 1);
      });
  return Developed(picture);
}

}  // namespace skerry::render
