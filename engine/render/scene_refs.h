#pragma once
#include <volk.h>

#include "engine/gpu/frame_graph.h"

namespace skerry::render {

/// What most passes of a frame read. Filled once by the renderer; passes that write replace the reference by its new version.
struct SceneRefs {
  gpu::BufferRef frame;           ///< shared::FrameConstants
  gpu::BufferRef sky;             ///< shared::SkyConstants
  gpu::BufferRef islands;         ///< shared::IslandTransform[view][island]
  gpu::BufferRef matrices;        ///< mat4 clip_from_source [view]
  gpu::BufferRef views;           ///< shared::CullView[view]
  gpu::BufferRef materials;       ///< shared::Material[block id]
  gpu::BufferRef quads, sections; ///< the geometry store
  gpu::BufferRef indices;         ///< 16-bit: 0 1 2 0 2 3, 4 5 6 ...
  gpu::BufferRef pixel_stats;     ///< shared::PixelStats
  gpu::ImageRef block_textures, sky_lut;
  VkSampler block_sampler{}, lut_sampler{}, point_sampler{};
  std::uint32_t islands_per_view = 0;
  VkExtent2D size{};
};

}  // namespace skerry::render
