#pragma once
#include <span>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"
#include "engine/gpu/graph/frame_graph.h"
#include "engine/gpu/transfer/uploader.h"
#include "engine/render/frame/frame_input.h"
#include "engine/render/frame/scene_refs.h"
#include "engine/render/frame/settings.h"
#include "engine/render/plan/frame_tables.h"
#include "engine/render/sky/panorama.h"
#include "engine/render/sky/sky_model.h"
#include "shaders/shared/sky.h"

namespace skerry::render {

/// What every frame reads: tables that are uploaded for each, and what is made once. Buffers grow
/// as they must and never shrink.
class FrameResources {
 public:
  explicit FrameResources(gpu::Device& device) : device_(&device) {}

  /// Makes what stays, and queues its contents. Errors: out of memory.
  Result<void> create(gpu::Uploader& uploader, std::span<const shared::Material> materials);
  /// From now on the sky of all frames; null: the air's sky again. Waits for the copy. Errors: out
  /// of memory.
  Result<void> set_panorama(gpu::Uploader& uploader, const Panorama* panorama);
  /// Queues a frame's tables. @param bake_sky the sky's table is made from them. Errors: out of
  /// memory.
  Result<void> upload(gpu::Uploader& uploader, const FrameTables& tables, const FrameInput& input,
                      const SkyModel& sky, bool bake_sky);
  /// Queues FrameInput::light_islands. Errors: out of memory.
  Result<void> upload_light_islands(gpu::Uploader& uploader, const FrameInput& input);
  /// A frame's references to all of it, and what the settings choose. Stores, clouds and corners
  /// are left to the caller.
  /// @param size of the G-buffer. @param tables lives until the graph has been executed.
  SceneRefs import(gpu::FrameGraph& graph, const FrameInput& input, const RenderSettings& settings,
                   VkExtent2D size, const FrameTables& tables);
  /// Stands in for texels that a shader names and does not read.
  gpu::Buffer& no_texels() { return no_texels_; }
  /// Makes room for so many sections in CullIn::seen. Errors: out of memory.
  Result<void> ensure_seen(gpu::Uploader& uploader, std::uint32_t sections);
  /// Queues what the sky sends to each island (sky_irradiance()). Errors: out of memory.
  Result<void> upload_skies(gpu::Uploader& uploader, std::span<const glm::uvec4> irradiance);
  gpu::BufferRef import_skies(gpu::FrameGraph& graph) {
    return graph.import(island_skies_ ? island_skies_ : no_texels_);
  }
  gpu::BufferRef import_seen(gpu::FrameGraph& graph) { return graph.import(seen_); }
  gpu::BufferRef import_light_islands(gpu::FrameGraph& graph) {
    return graph.import(light_islands_);
  }

 private:
  enum class ReadBy : std::uint8_t { kBlocks, kTexels };
  Result<void> reserve(gpu::Buffer& buffer, const char* name, std::uint64_t size_bytes,
                       ReadBy read_by = ReadBy::kBlocks);
  template <class T>
  Result<void> upload(gpu::Uploader& uploader, gpu::Buffer& to, const char* name,
                      std::span<const T> values, ReadBy read_by = ReadBy::kBlocks);
  Result<void> create_indices(gpu::Uploader& uploader);
  Result<void> create_textures(gpu::Uploader& uploader);
  Result<void> create_images(gpu::Uploader& uploader);
  Result<void> create_samplers();

  gpu::Device* device_;
  gpu::Buffer frame_, sky_, sky_scattering_, islands_, views_, light_islands_, materials_, indices_,
      pixel_stats_, exposure_, no_texels_, seen_, island_skies_;
  gpu::Image block_textures_, block_coverage_, sky_lut_, no_volume_, no_words_, no_depths_,
      no_layers_;
  gpu::Image panorama_;  // none: sky_lut_ is the sky
  VkSampler block_sampler_{}, lut_sampler_{}, panorama_sampler_{}, point_sampler_{};
};

}  // namespace skerry::render
