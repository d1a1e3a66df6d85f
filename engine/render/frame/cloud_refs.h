#pragma once
#include <volk.h>

#include <cstdint>
#include <vector>

#include "engine/gpu/graph/bindings.h"
#include "engine/gpu/graph/frame_graph.h"
#include "shaders/shared/bindings.h"

namespace skerry::render {

/// A frame's clouds on the GPU: what passes need that include shaders/include/sky/cloud_*.glsl.
struct CloudRefs {
  gpu::BufferRef constants;                ///< shared::CloudConstants
  gpu::ImageRef weather, shapes, billows;  ///< noise of the layer; where there is none, others
  gpu::ImageRef cells, bricks;  ///< of the volumes; where there are none, the layer's light
  gpu::ImageRef layer_light,
      volume_light;  ///< optical depths; some 3D image if nothing lights them
  VkSampler repeating{}, linear{}, nearest{};
  bool layer = false;
  bool sky = false;  ///< it lights them by itself, along the way to the zenith
  std::uint32_t volumes = 0;

  /// Adds what the programs are specialised by.
  std::vector<gpu::SpecConstant> with_clouds(std::vector<gpu::SpecConstant> own) const;
  /// What cloud_light.glsl reads: how much light comes through.
  void declare_light(gpu::PassBuilder& builder) const;
  auto light_bindings() const {
    return std::tuple{gpu::storage<shared::kCloudsBinding>(constants),
                      gpu::sampled<shared::kLayerLightBinding>(layer_light, linear),
                      gpu::sampled<shared::kVolumeLightBinding>(volume_light, linear)};
  }
  /// What a march reads besides.
  void declare_media(gpu::PassBuilder& builder) const;
  auto media_bindings() const {
    return std::tuple{gpu::sampled<shared::kCloudWeatherBinding>(weather, repeating),
                      gpu::sampled<shared::kCloudCellsBinding>(cells, nearest),
                      gpu::sampled<shared::kCloudBricksBinding>(bricks, linear),
                      gpu::sampled<shared::kCloudShapesBinding>(shapes, repeating),
                      gpu::sampled<shared::kCloudBillowsBinding>(billows, repeating)};
  }
};

}  // namespace skerry::render
