#pragma once
#include <tuple>
#include <vector>

#include "engine/gpu/graph/bindings.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/program/pipeline.h"
#include "engine/render/frame/scene_refs.h"
#include "shaders/shared/bindings.h"

namespace skerry::render {

/// What shading passes write to, as shaders/include/post/output.glsl has it.
struct ShadeTarget {
  gpu::ImageRef radiance;  ///< RGBA16F; empty: no pixel's is kept
  gpu::ImageRef picture;   ///< RGBA8, of all pixels; empty: none. If both, radiance is that of
                           ///< FrameConstants::radiance_area
  gpu::ImageRef metered;   ///< R32F, luminance for the meter of what goes to the picture, a texel
                           ///< for each meter_stride x meter_stride pixels; empty: none is kept
  std::uint32_t meter_stride = 0;  ///< 0 without `metered`

  void declare(gpu::PassBuilder& b, const SceneRefs& scene);
  /// A shader's own specialization constants and those of output.glsl.
  std::vector<gpu::SpecConstant> with_output(std::vector<gpu::SpecConstant> own,
                                             const SceneRefs& scene) const;
  auto bindings(const SceneRefs& scene) const {
    const gpu::ImageRef some = radiance ? radiance : picture;
    return std::tuple{
        gpu::storage<shared::kRadianceBinding>(some),
        gpu::storage<shared::kTargetBinding>(picture ? picture : some),
        gpu::storage<shared::kMeteredBinding>(metered ? metered : some),
        gpu::storage<shared::kExposureBinding>(picture ? scene.exposure : scene.frame)};
  }
};

}  // namespace skerry::render
