#pragma once
#include <shader_names.h>

#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/gpu/graph/bindings.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/bloom.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

/// What filter_radiance.comp works on; what a step does not use is bound to another of its images.
struct RadianceFilter {
  gpu::ImageRef fine, coarse, made;  ///< RGBA16F
  gpu::ImageRef total;               ///< RGBA32F
  gpu::BufferRef exposure;
  gpu::BufferRef dispatches = exposure, tiles = exposure;  ///< kListedConstant: of what is made
  struct Push {
    shared::BloomStep step;
    float share = 0.0f;  ///< of a part in the total
  } push{};

  /// An image for steps that add nothing up.
  static gpu::ImageRef no_total(gpu::FrameGraph& graph) {
    return graph.create(gpu::ImageDesc{
        .name = "no total", .format = VK_FORMAT_R32G32B32A32_SFLOAT, .extent = {1, 1}});
  }
  static auto program(gpu::Pipelines& pipelines, std::uint32_t step,
                      std::vector<gpu::SpecConstant> constants) {
    constants.push_back({shared::kFilterConstant, step});
    return gpu::compute(pipelines, programs::kFilterRadiance, std::move(constants));
  }
  auto bindings() const {
    return std::tuple{gpu::storage<shared::kFineBloomBinding>(fine),
                      gpu::storage<shared::kCoarseBloomBinding>(coarse),
                      gpu::storage<shared::kMadeBloomBinding>(made),
                      gpu::storage<shared::kTotalBinding>(total),
                      gpu::storage<shared::kExposureBinding>(exposure),
                      gpu::storage<shared::kTileDispatchesBinding>(dispatches),
                      gpu::storage<shared::kTilesBinding>(tiles),
                      gpu::constants(push)};
  }
};

}  // namespace skerry::render
