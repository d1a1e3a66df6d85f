#include "engine/render/post/bloom_pass.h"
#include "engine/gpu/graph/bindings.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

#include <shader_names.h>
#include <algorithm>
#include <string>
#include <vector>

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
      },
      [fine, coarse, step, exposure = scene.exposure,
       program =
           gpu::compute(pipelines, programs::kFilterBloom,
                        {{shared::kFirstConstant, level.index == 1 ? 1u : 0u}})](gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFineBloomBinding>(fine),
                  gpu::storage<shared::kCoarseBloomBinding>(fine),  // not read
                  gpu::storage<shared::kMadeBloomBinding>(coarse),
                  gpu::storage<shared::kExposureBinding>(exposure), gpu::constants(step));
        dispatch_over(c, step.coarse_size);
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
      },
      [fine, coarse, exposure = scene.exposure, step = level.step,
       program = gpu::compute(pipelines, programs::kFilterBloom, {{shared::kSpreadConstant, 1}})](
          gpu::Commands& c) {
        gpu::bind(c, program, gpu::storage<shared::kFineBloomBinding>(fine),
                  gpu::storage<shared::kCoarseBloomBinding>(coarse),
                  gpu::storage<shared::kMadeBloomBinding>(fine),
                  gpu::storage<shared::kExposureBinding>(exposure), gpu::constants(step));
        dispatch_over(c, step.fine_size);
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
  std::vector<gpu::ImageRef> images{radiance};
  std::vector<shared::BloomStep> steps;
  VkExtent2D size = scene.size;
  for (std::uint32_t level = 1; level <= levels; ++level) {
    steps.push_back(step_between(size, halved(size), settings));
    images.push_back(shrink(graph, pipelines, scene, images.back(), {steps.back(), level}));
    size = halved(size);
  }
  for (std::uint32_t level = levels - 1; level >= 1; --level)
    images[level] =
        spread(graph, pipelines, scene, images[level], images[level + 1], {steps[level], level});
  return {images[1], steps[0]};
}

}  // namespace skerry::render
