#include "engine/render/post/meter_pass.h"

#include <shader_names.h>
#include <tuple>

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

/// What meter_radiance.comp works on.
struct MeterStep {
  gpu::BufferRef frame, histogram, exposure;
  gpu::ImageRef radiance, picture, cells;
  shared::Metering metering;
  bool has_radiance = true, has_cells = false;  // if not, it is a texel that is never read

  auto bindings() const {
    return std::tuple{gpu::storage<shared::kFrameBinding>(frame),
                      gpu::storage<shared::kRadianceBinding>(radiance),
                      gpu::storage<shared::kMeteredBinding>(cells),
                      gpu::storage<shared::kHistogramBinding>(histogram),
                      gpu::storage<shared::kExposureBinding>(exposure),
                      gpu::storage<shared::kPictureBinding>(picture),
                      gpu::constants(metering)};
  }
};

/// Bound where a step has no use for an image.
gpu::ImageRef unread(gpu::FrameGraph& graph, const char* name, VkFormat format) {
  return graph.create(gpu::ImageDesc{.name = name, .format = format, .extent = {1, 1}});
}

/// What each step declares, whether it reads and writes it or not.
void declare(gpu::PassBuilder& b, MeterStep& in) {
  b.read(in.frame, Use::kComputeRead);
  for (gpu::ImageRef* const image : {&in.radiance, &in.cells}) {
    const bool made = image == &in.radiance ? in.has_radiance : in.has_cells;
    if (made)
      b.read(*image, Use::kComputeRead);
    else
      *image = b.write(*image, Use::kComputeWrite);
  }
  in.histogram = b.write(in.histogram, Use::kComputeWrite);
  in.exposure = b.write(in.exposure, Use::kComputeWrite);
  in.picture = b.write(in.picture, Use::kComputeWrite);
}

}  // namespace

Metered MeterPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                       const MeterIn& in, const MeterSettings& settings, bool decides) {
  MeterStep m{
      scene.frame,
      {},
      scene.exposure,
      in.radiance ? in.radiance : unread(graph, "no radiance", VK_FORMAT_R16G16B16A16_SFLOAT),
      unread(graph, "no picture", VK_FORMAT_R8G8B8A8_UNORM),
      in.cells ? in.cells : unread(graph, "no cells", VK_FORMAT_R32_SFLOAT),
      metering_of(settings, decides),
      bool{in.radiance},
      bool{in.cells}};
  m.histogram =
      graph.create(gpu::BufferDesc{"histogram", shared::kHistogramBins * sizeof(std::uint32_t)});
  std::vector<gpu::SpecConstant> cells;
  if (in.cells) cells.push_back({shared::kMeterStrideConstant, m.metering.stride});
  graph.add_pass(
      "clear_histogram",
      [&](gpu::PassBuilder& b) { m.histogram = b.write(m.histogram, Use::kTransferWrite); },
      [histogram = m.histogram](gpu::Commands& c) { c.fill(histogram, 0, VK_WHOLE_SIZE, 0); });
  graph.add_pass(
      "meter_radiance", [&](gpu::PassBuilder& b) { declare(b, m); },
      [m, size = scene.size,
       program =
           gpu::compute(pipelines, programs::kMeterRadiance, std::move(cells))](gpu::Commands& c) {
        const auto groups = [&](std::uint32_t pixels) {
          return gpu::Commands::groups(gpu::Commands::groups(pixels, m.metering.stride),
                                       shared::kMeterGroup);
        };
        gpu::bind(c, program, m.bindings());
        c.dispatch(groups(size.width), groups(size.height), 1);
      });
  graph.add_pass(
      "choose_exposure", [&](gpu::PassBuilder& b) { declare(b, m); },
      [m, program = gpu::compute(pipelines, programs::kMeterRadiance,
                                 {{shared::kChooseConstant, 1}})](gpu::Commands& c) {
        gpu::bind(c, program, m.bindings());
        c.dispatch(1, 1, 1);
      });
  scene.exposure = m.exposure;
  return {m.histogram, m.radiance};
}

Developed MeterPass::show(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, SceneRefs& scene,
                          Developed developed, const Metered& metered,
                          const MeterSettings& settings) {
  MeterStep m{scene.frame,
              metered.histogram,
              scene.exposure,
              metered.radiance,
              developed.picture(),
              unread(graph, "no cells", VK_FORMAT_R32_SFLOAT),
              metering_of(settings, false)};
  graph.add_pass(
      "show_exposure", [&](gpu::PassBuilder& b) { declare(b, m); },
      [m, size = scene.size,
       program = gpu::compute(pipelines, programs::kMeterRadiance, {{shared::kShowConstant, 1}})](
          gpu::Commands& c) {
        gpu::bind(c, program, m.bindings());
        c.dispatch(gpu::Commands::groups(size.width, shared::kMeterGroup),
                   gpu::Commands::groups((size.height + 2) / 3, shared::kMeterGroup), 1);
      });
  scene.exposure = m.exposure;
  return Developed(m.picture);
}

}  // namespace skerry::render
