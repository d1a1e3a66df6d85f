#include "engine/render/post/bloom_pass.h"

#include <algorithm>
#include <string>
#include <vector>

#include "engine/render/post/radiance_filter.h"

namespace skerry::render {
namespace {

using gpu::Use;

VkExtent2D halved(VkExtent2D size) {
  return {(size.width + 1) / 2, (size.height + 1) / 2};
}

/// A step of the pyramid.
struct Level {
  shared::BloomStep step;
  std::uint32_t index = 0;  // of the level that is made
  gpu::ImageRef& no_total;
};

shared::BloomStep step_between(VkExtent2D fine, VkExtent2D coarse, const BloomSettings& settings) {
  return {{fine.width, fine.height},
          {coarse.width, coarse.height},
          settings.threshold,
          settings.intensity};
}

void dispatch_over(gpu::Commands& c, glm::uvec2 size) {
  c.dispatch(gpu::Commands::groups(size.x, 8), gpu::Commands::groups(size.y, 8), 1);
}

/// @return the coarser level.
gpu::ImageRef shrink(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                     gpu::ImageRef fine, const Level& level) {
  const shared::BloomStep& step = level.step;
  gpu::ImageRef coarse =
      graph.create(gpu::ImageDesc{.name = "bloom " + std::to_string(level.index),
                                  .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                  .extent = {step.coarse_size.x, step.coarse_size.y}});
  graph.add_pass(
      "shrink_bloom_" + std::to_string(level.index),
      [&](gpu::PassBuilder& b) {
        b.read(fine, Use::kComputeRead);
        b.read(scene.exposure, Use::kComputeRead);
        coarse = b.write(coarse, Use::kComputeWrite);
        level.no_total =
            b.write(level.no_total, Use::kComputeWrite);  // by the shader's other steps
      },
      [filter = RadianceFilter{fine, fine, coarse, level.no_total, scene.exposure, {step}},
       program = RadianceFilter::program(pipelines, shared::kFilterShrink,
                                         {{shared::kFirstConstant, level.index == 1 ? 1u : 0u}})](
          gpu::Commands& c) {
        gpu::bind(c, program, filter.bindings());
        dispatch_over(c, filter.push.step.coarse_size);
      });
  return coarse;
}

/// @return the finer level, with the coarser ones in it.
gpu::ImageRef spread(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                     gpu::ImageRef fine, gpu::ImageRef coarse, const Level& level) {
  graph.add_pass(
      "spread_bloom_" + std::to_string(level.index),
      [&](gpu::PassBuilder& b) {
        b.read(coarse, Use::kComputeRead);
        b.read(scene.exposure, Use::kComputeRead);
        fine = b.write(fine, Use::kComputeWrite);
        level.no_total =
            b.write(level.no_total, Use::kComputeWrite);  // by the shader's other steps
      },
      [filter = RadianceFilter{fine, coarse, fine, level.no_total, scene.exposure, {level.step}},
       program = RadianceFilter::program(pipelines, shared::kFilterSpread, {})](gpu::Commands& c) {
        gpu::bind(c, program, filter.bindings());
        dispatch_over(c, filter.push.step.fine_size);
      });
  return fine;
}

}  // namespace

std::uint32_t bloom_levels(VkExtent2D size, int asked) {
  std::uint32_t levels = 1;
  for (VkExtent2D s = halved(size);
       levels < static_cast<std::uint32_t>(asked) && (s.width > 1 || s.height > 1); s = halved(s))
    ++levels;
  return levels;
}

Bloom BloomPass::add(gpu::FrameGraph& graph, gpu::Pipelines& pipelines, const SceneRefs& scene,
                     gpu::ImageRef radiance, const BloomSettings& settings) {
  const std::uint32_t levels = bloom_levels(scene.size, settings.levels);
  gpu::ImageRef no_total = RadianceFilter::no_total(graph);
  std::vector<gpu::ImageRef> images{radiance};
  std::vector<shared::BloomStep> steps;
  VkExtent2D size = scene.size;
  for (std::uint32_t level = 1; level <= levels; ++level) {
    steps.push_back(step_between(size, halved(size), settings));
    images.push_back(
        shrink(graph, pipelines, scene, images.back(), {steps.back(), level, no_total}));
    size = halved(size);
  }
  for (std::uint32_t level = levels - 1; level >= 1; --level)
    images[level] = spread(graph, pipelines, scene, images[level], images[level + 1],
                           {steps[level], level, no_total});
  return {images[1], steps[0]};
}

}  // namespace skerry::render
