#pragma once
#include <volk.h>

#include <cstdint>
#include <vector>

#include "engine/gpu/graph/frame_graph.h"

namespace skerry::render {

/// A frame's clouds on the GPU: what passes need that include shaders/include/cloud_*.glsl.
struct CloudRefs {
  gpu::BufferRef constants;                ///< shared::CloudConstants
  gpu::ImageRef weather, shapes, billows;  ///< noise of the layer; where there is none, others
  gpu::ImageRef cells, bricks;  ///< of the volumes; where there are none, the layer's light
  gpu::ImageRef layer_light,
      volume_light;  ///< optical depths; some 3D image if nothing lights them
  VkSampler repeating{}, linear{}, nearest{};
  bool layer = false;
  std::uint32_t volumes = 0;

  /// Adds what the programs are specialised by.
  std::vector<gpu::SpecConstant> with_clouds(std::vector<gpu::SpecConstant> own) const;
  /// What cloud_light.glsl reads: how much light comes through.
  void declare_light(gpu::PassBuilder& builder) const;
  void bind_light(gpu::Commands& commands) const;
  /// What a march reads besides.
  void declare_media(gpu::PassBuilder& builder) const;
  void bind_media(gpu::Commands& commands) const;
};

}  // namespace skerry::render
