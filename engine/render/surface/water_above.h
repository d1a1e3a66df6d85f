#pragma once
#include <vector>

#include "engine/gpu/graph/bindings.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/surface/translucent_pass.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/constants.h"

namespace skerry::render {

/// What shaders read that find out how deep under water a surface lies
/// (shaders/include/surface/under_water.glsl).
class WaterAbove {
 public:
  /// @param layers that lie before the surfaces; none: a frame without water and glass.
  WaterAbove(const SceneRefs& scene, const TranslucentPass::Layers& layers)
      : any_(layers.count != 0),
        // In place of what is then never read.
        depth_(any_ ? layers.under_water : scene.no_depths) {}

  std::vector<gpu::SpecConstant> with_water(std::vector<gpu::SpecConstant> own) const {
    if (any_) own.push_back({shared::kUnderWaterConstant, 1});
    return own;
  }
  void declare(gpu::PassBuilder& builder) const { builder.read(depth_, gpu::Use::kComputeSampled); }
  auto binding(VkSampler point) const {
    return gpu::sampled<shared::kUnderWaterBinding>(depth_, point);
  }

 private:
  bool any_;
  gpu::ImageRef depth_;
};

}  // namespace skerry::render
